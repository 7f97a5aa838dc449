#include "core/scene/light_clustering.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace mote::core {
namespace {

constexpr int buckets = 16;

/// M_Omega: of the directions that a cluster shines in (Eq. 1).
double orientation_measure(const LightBounds& cluster) {
    const double o = std::max(double(cluster.normals.angle), 0.0),
                 w = std::min(o + double(cluster.reach), double(pi));
    return 2.0 * double(pi) * (1.0 - std::cos(o)) +
           0.5 * double(pi) *
               (2.0 * w * std::sin(o) - std::cos(o - 2.0 * w) - 2.0 * o * std::sin(o) + std::cos(o));
}

double cost(const LightBounds& cluster) {
    const Vec3d d(cluster.box.diagonal());
    return cluster.intensity * orientation_measure(cluster) * glm::dot(d, d);
}

int bucket_of(const Vec3& c, const Bounds3& centers, int axis) {
    const float width = centers.upper[axis] - centers.lower[axis];
    return std::clamp(int(float(buckets) * ((c[axis] - centers.lower[axis]) / width)), 0, buckets - 1);
}

}  // namespace

LightClustering::LightClustering(std::span<const LightBounds> lights)
    : lights_(lights), order_(lights.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
}

LightRun LightClustering::run(std::uint32_t begin, std::uint32_t end) const {
    LightRun result{begin, end, {}};
    for (std::uint32_t i = begin; i < end; ++i) result.bounds = united(result.bounds, lights_[order_[i]]);
    return result;
}

std::vector<LightRun> LightClustering::cut_into(const LightRun& run, std::size_t count) {
    std::vector<LightRun> runs{run};
    while (runs.size() < count) {
        // One light is below all that can be cut, and a pile of lights in one place just above.
        const auto gain = [](const LightRun& r) { return r.size() == 1 ? -1.0 : cost(r.bounds); };
        const auto dearest = std::max_element(
            runs.begin(), runs.end(), [&](const auto& a, const auto& b) { return gain(a) < gain(b); });
        if (dearest->size() == 1) break;
        const std::uint32_t second = middle(*dearest), end = dearest->end;
        *dearest = this->run(dearest->begin, second);
        runs.push_back(this->run(second, end));
    }
    return runs;
}

/// Sorts the run into two and returns where the second begins.
std::uint32_t LightClustering::middle(const LightRun& run) {
    Bounds3 centers;
    for (std::uint32_t i = run.begin; i < run.end; ++i) centers.extend(center(i));
    const std::uint32_t half = run.begin + run.size() / 2;
    const Cut best = cheapest(run, centers);
    if (best.axis < 0) return half;  // all in one place: any cut is as good
    const auto second = std::partition(order_.begin() + run.begin, order_.begin() + run.end, [&](auto light) {
        return bucket_of(lights_[light].box.center(), centers, best.axis) <= best.bucket;
    });
    const auto begin = std::uint32_t(second - order_.begin());
    return begin == run.begin || begin == run.end ? half : begin;
}

LightClustering::Cut LightClustering::cheapest(const LightRun& run, const Bounds3& centers) const {
    Cut best;
    double least = std::numeric_limits<double>::infinity();
    const float longest = max_component(centers.diagonal());
    for (int axis = 0; axis < 3; ++axis) {
        const float width = centers.upper[axis] - centers.lower[axis];
        if (!(width > 0.0f)) continue;
        std::array<LightBounds, buckets> in{};
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            LightBounds& bucket = in[std::size_t(bucket_of(center(i), centers, axis))];
            bucket = united(bucket, lights_[order_[i]]);
        }
        std::array<double, buckets> after{};  // cost of the buckets behind each cut
        LightBounds behind;
        for (int b = buckets - 1; b > 0; --b) {
            behind = united(behind, in[std::size_t(b)]);
            after[std::size_t(b - 1)] = behind.box.empty() ? double(infinity) : cost(behind);
        }
        LightBounds before;
        for (int b = 0; b < buckets - 1; ++b) {
            before = united(before, in[std::size_t(b)]);
            if (before.box.empty()) continue;
            // Thin slices are dearer (the paper's K_r).
            const double sum = double(longest / width) * (cost(before) + after[std::size_t(b)]);
            if (sum < least) least = sum, best = {axis, b};
        }
    }
    return best;
}

}  // namespace mote::core
