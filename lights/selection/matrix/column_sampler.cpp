#include "lights/selection/matrix/column_sampler.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

namespace {
/// Smallest weight of a member over the mean of its cluster, so that prefix sums always grow.
constexpr double min_weight = 1e-9;
}  // namespace

ColumnSampler::ColumnSampler(ColumnClusters clusters, std::span<const float> weights)
    : clusters_(std::move(clusters)), upto_(clusters_.members.size()) {
    for (std::size_t k = 0; k < clusters_.size(); ++k) {
        const auto members = clusters_.cluster(k);
        double sum = 0.0;
        for (const std::uint32_t j : members) sum += double(weights[j]);
        const double least = sum > 0.0 ? min_weight * sum / double(members.size()) : 1.0;
        double upto = 0.0;
        for (std::size_t i = 0; i < members.size(); ++i) {
            upto += std::max(double(weights[members[i]]), least);
            upto_[clusters_.first[k] + i] = upto;
        }
    }
}

double ColumnSampler::weight(std::size_t i) const {
    const auto next = std::upper_bound(clusters_.first.begin(), clusters_.first.end(), i);
    return upto_[i] - (i > *(next - 1) ? upto_[i - 1] : 0.0);
}

double ColumnSampler::probability(std::size_t i) const {
    const auto next = std::upper_bound(clusters_.first.begin(), clusters_.first.end(), i);
    return weight(i) / upto_[*next - 1];
}

void ColumnSampler::sample(Rng& rng, std::vector<WeightedVpl>& samples) const {
    for (std::size_t k = 0; k < clusters_.size(); ++k) {
        const std::size_t first = clusters_.first[k], last = clusters_.first[k + 1];
        if (last - first == 1) {
            samples.push_back({clusters_.members[first]});
            continue;
        }
        const std::uint64_t bits = std::uint64_t(rng.next_u32()) << 21 ^ rng.next_u32() >> 11;  // 53
        const double all = upto_[last - 1], u = double(bits) * 0x1p-53 * all;
        const auto begin = upto_.begin() + std::ptrdiff_t(first), end = upto_.begin() + std::ptrdiff_t(last);
        const auto at = std::min(std::upper_bound(begin, end, u), end - 1);
        const double weight = *at - (at > begin ? *(at - 1) : 0.0);
        const auto i = std::size_t(at - upto_.begin());
        samples.push_back({clusters_.members[i], float(all / weight)});
    }
}

}  // namespace mote::lights
