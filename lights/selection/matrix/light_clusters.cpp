#include "lights/selection/matrix/light_clusters.h"

#include <algorithm>
#include <array>

namespace mote::lights {

using namespace core;

namespace {

void append(ColumnClusters& all, const ColumnClusters& more) {
    const std::size_t begin = all.members.size();
    all.members.insert(all.members.end(), more.members.begin(), more.members.end());
    for (std::size_t k = 1; k < more.first.size(); ++k) all.first.push_back(begin + more.first[k]);
}

/// Neighbours in the order of lights, of about equal weight each.
ColumnClusters in_order(std::span<const std::uint32_t> members, std::span<const float> weights,
                        std::size_t count) {
    ColumnClusters result;
    result.members.assign(members.begin(), members.end());
    double all = 0.0, upto = 0.0;
    for (const std::uint32_t j : members) all += double(weights[j]);
    for (std::size_t i = 0; i < members.size(); ++i) {
        upto += double(weights[members[i]]);
        const bool full = upto * double(count) >= all * double(result.first.size());
        if (i + 1 == members.size() || (full && result.first.size() < count)) result.first.push_back(i + 1);
    }
    return result;
}

/// Number of `columns` that each class has. Costs fall with the square of their number, so it is in
/// proportion to their roots.
std::array<std::size_t, 3> apportion(const ReducedMatrix& matrix, std::size_t columns,
                                     const std::array<std::vector<std::uint32_t>, 3>& members) {
    std::array<std::size_t, 3> count{};
    std::array<double, 2> root{};
    for (std::size_t c = 0; c < 2; ++c) root[c] = std::sqrt(cluster_cost(matrix.columns(), members[c]));
    count[2] = members[2].empty() ? 0 : std::max<std::size_t>(1, columns / 16);
    const std::size_t rest = columns - std::min(columns, count[2]);
    const double both = root[0] + root[1];
    count[1] = both > 0.0 ? std::size_t(double(rest) * root[1] / both) : 0;
    count[1] =
        members[1].empty() ? 0 : std::clamp<std::size_t>(count[1], 1, std::max<std::size_t>(1, rest / 2));
    count[0] = members[0].empty() ? 0 : std::max<std::size_t>(1, rest - std::min(rest, count[1]));
    return count;
}

}  // namespace

ColumnClusters cluster_lights(const ReducedMatrix& matrix, std::size_t columns, Rng& rng,
                              CancelToken cancelled) {
    std::array<std::vector<std::uint32_t>, 3> members;
    for (std::uint32_t j = 0; j < matrix.classes.size(); ++j)
        if (matrix.classes[j] != LightClass::none) members[std::size_t(matrix.classes[j])].push_back(j);
    const auto count = apportion(matrix, columns, members);
    ColumnClusters clusters;
    for (std::size_t c = 0; c < 2; ++c)
        append(clusters, cluster_columns(matrix.columns(), members[c], count[c], rng, cancelled));
    append(clusters, in_order(members[2], matrix.weights, count[2]));
    return clusters;
}

}  // namespace mote::lights
