#include "lights/selection/matrix/column_clusters.h"

#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <algorithm>
#include <numeric>

#include "lights/selection/matrix/column_split.h"

namespace mote::lights {

using namespace core;

namespace {

using Column = Eigen::Map<const Eigen::VectorXf>;

constexpr std::size_t chunk = 1024;  // columns of a task

Column column_of(const Columns& columns, std::uint32_t j) {
    return {columns.column(j), Eigen::Index(columns.rows)};
}

struct Sum {
    double norms = 0.0;
    Eigen::VectorXd columns;
};

Sum sum_of(const Columns& columns, std::span<const std::uint32_t> members) {
    Sum sum{0.0, Eigen::VectorXd::Zero(Eigen::Index(columns.rows))};
    for (const std::uint32_t j : members) {
        const auto x = column_of(columns, j);
        sum.norms += double(x.norm()), sum.columns += x.cast<double>();
    }
    return sum;
}

double cost_of(const Sum& sum) { return std::max(0.0, sum.norms * sum.norms - sum.columns.squaredNorm()); }

/// Unit columns, sampled in proportion to what each costs with all others,
///   alpha_i = sum over j of ||x_i|| ||x_j|| ||x_i/||x_i|| - x_j/||x_j|| ||^2
///           = 2 (||x_i|| sum ||x_j|| - x_i . sum x_j),
/// by numbers at even distances.
Eigen::MatrixXf sample_centres(const Columns& columns, std::span<const std::uint32_t> members, const Sum& sum,
                               std::size_t count, Rng& rng) {
    std::vector<double> alpha(members.size());
    double all = 0.0;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const auto x = column_of(columns, members[i]);
        alpha[i] = std::max(0.0, double(x.norm()) * sum.norms - x.cast<double>().dot(sum.columns));
        all += alpha[i];
    }
    std::vector<std::uint32_t> sampled;
    double next = all / double(count) * double(rng.next_float()), upto = 0.0;
    for (std::size_t i = 0; i < members.size() && sampled.size() < count; ++i) {
        upto += alpha[i];
        if (!(alpha[i] > 0.0) || upto <= next) continue;
        sampled.push_back(members[i]);
        while (next < upto) next += all / double(count);
    }
    Eigen::MatrixXf centres(Eigen::Index(sampled.size()), Eigen::Index(columns.rows));
    for (std::size_t k = 0; k < sampled.size(); ++k)
        centres.row(Eigen::Index(k)) = column_of(columns, sampled[k]).normalized().transpose();
    return centres;
}

/// The centre whose direction is nearest, of each member.
std::vector<std::uint32_t> assign(const Columns& columns, std::span<const std::uint32_t> members,
                                  const Eigen::MatrixXf& centres, CancelToken cancelled) {
    std::vector<std::uint32_t> nearest(members.size());
    tbb::parallel_for(std::size_t(0), (members.size() + chunk - 1) / chunk, [&](std::size_t c) {
        cancelled.check();
        const std::size_t first = c * chunk, count = std::min(chunk, members.size() - first);
        Eigen::MatrixXf own(Eigen::Index(columns.rows), Eigen::Index(count));
        for (std::size_t i = 0; i < count; ++i)
            own.col(Eigen::Index(i)) = column_of(columns, members[first + i]);
        const Eigen::MatrixXf cosines = centres * own;
        for (std::size_t i = 0; i < count; ++i) {
            Eigen::Index best = 0;
            cosines.col(Eigen::Index(i)).maxCoeff(&best);
            nearest[first + i] = std::uint32_t(best);
        }
    });
    return nearest;
}

struct Cluster {
    std::size_t first, count;
    double cost;
};

/// Members in the order of their centres, and the clusters that are not empty.
std::vector<Cluster> sort_by_centre(const Columns& columns, std::span<const std::uint32_t> members,
                                    std::span<const std::uint32_t> nearest, std::size_t centres,
                                    std::vector<std::uint32_t>& order) {
    std::vector<std::size_t> first(centres + 1, 0);
    for (const std::uint32_t k : nearest) ++first[k + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    order.resize(members.size());
    for (std::size_t i = 0; i < members.size(); ++i) order[next[nearest[i]]++] = members[i];
    std::vector<Cluster> clusters;
    for (std::size_t k = 0; k < centres; ++k)
        if (first[k + 1] > first[k]) clusters.push_back({first[k], first[k + 1] - first[k], 0.0});
    tbb::parallel_for(std::size_t(0), clusters.size(), [&](std::size_t k) {
        clusters[k].cost =
            cluster_cost(columns, std::span(order).subspan(clusters[k].first, clusters[k].count));
    });
    return clusters;
}

/// Until there are `count`: the most expensive cluster in two.
void split_all(const Columns& columns, std::vector<std::uint32_t>& order, std::vector<Cluster>& clusters,
               std::size_t count, CancelToken cancelled) {
    const auto cheaper = [](const Cluster& a, const Cluster& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.first > b.first;
    };
    std::make_heap(clusters.begin(), clusters.end(), cheaper);
    while (clusters.size() < count && clusters.front().cost > 0.0) {
        cancelled.check();
        std::pop_heap(clusters.begin(), clusters.end(), cheaper);
        const Cluster whole = clusters.back();
        clusters.pop_back();
        const auto part = std::span(order).subspan(whole.first, whole.count);
        const std::size_t left = split_columns(columns, part);
        const auto add = [&](std::size_t first, std::size_t n, double cost) {
            clusters.push_back({whole.first + first, n, cost});
            std::push_heap(clusters.begin(), clusters.end(), cheaper);
        };
        if (left == 0) {
            add(0, whole.count, 0.0);  // as good as one direction
            continue;
        }
        add(0, left, cluster_cost(columns, part.first(left)));
        add(left, whole.count - left, cluster_cost(columns, part.subspan(left)));
    }
}

}  // namespace

double cluster_cost(const Columns& columns, std::span<const std::uint32_t> members) {
    return cost_of(sum_of(columns, members));
}

ColumnClusters cluster_columns(const Columns& columns, std::span<const std::uint32_t> members,
                               std::size_t count, Rng& rng, CancelToken cancelled) {
    ColumnClusters result;
    if (members.empty() || count == 0) return result;
    const Sum sum = sum_of(columns, members);
    std::vector<Cluster> clusters{{0, members.size(), cost_of(sum)}};
    result.members.assign(members.begin(), members.end());
    const std::size_t sampled = count * 2 / 3;
    if (sampled > 1 && clusters[0].cost > 0.0) {
        const Eigen::MatrixXf centres = sample_centres(columns, members, sum, sampled, rng);
        if (centres.rows() > 1) {
            const auto nearest = assign(columns, members, centres, cancelled);
            clusters = sort_by_centre(columns, members, nearest, std::size_t(centres.rows()), result.members);
        }
    }
    split_all(columns, result.members, clusters, count, cancelled);
    std::sort(clusters.begin(), clusters.end(),
              [](const Cluster& a, const Cluster& b) { return a.first < b.first; });
    for (const Cluster& c : clusters) result.first.push_back(c.first + c.count);
    return result;
}

}  // namespace mote::lights
