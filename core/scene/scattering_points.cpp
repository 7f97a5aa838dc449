#include "core/scene/scattering_points.h"

#include <algorithm>

namespace mote::core {

void ScatteringPoints::start(const Rng& rng) {
    rng_ = rng;
    parts_.clear(), candidates_.clear(), chosen_.clear();
}

void ScatteringPoints::begin_part(const MediumState& state, float first, float last) {
    parts_.push_back({state, first, last});
}

float ScatteringPoints::distance_of(const ScatteringPoint& point, const Ray& ray) const {
    const Part& part = parts_[point.part];
    const float t = glm::dot(point.position - ray.origin, ray.direction);
    return t < ray.t_min ? t : std::clamp(t, part.first, part.last);  // before: on an earlier ray
}

void ScatteringPoints::add(const Vec3& position, const Rgb& weight) {
    if (count_ == 0 || !(max_component(weight) > 0.0f)) return;
    if (candidates_.size() == max_candidates) {  // half as many replace them, with the same mean
        sample(candidates_, max_candidates / 2, chosen_);
        candidates_.swap(chosen_);
    }
    candidates_.push_back({position, weight, std::uint32_t(parts_.size() - 1)});
}

double ScatteringPoints::sample(const std::vector<ScatteringPoint>& from, std::size_t count,
                                std::vector<ScatteringPoint>& to) {
    to.clear();
    double sum = 0.0;
    for (const ScatteringPoint& c : from) sum += average(c.weight);
    const double step = sum / double(count);
    double passed = 0.0, next = step * double(rng_.next_float());
    for (const ScatteringPoint& c : from) {
        const double weight = average(c.weight);
        passed += weight;
        // Each is sampled weight / step times on average. The last one ends what rounding has left over.
        for (; to.size() < count && (next < passed || &c == &from.back()); next += step)
            to.push_back({c.position, c.weight * float(step / weight), c.part});
    }
    return sum;
}

std::span<const ScatteringPoint> ScatteringPoints::choose(float rare) {
    if (candidates_.empty()) return {};
    const auto count = std::size_t(count_);
    const double sum = sample(candidates_, count, chosen_);
    const auto first = std::min(std::size_t(rng_.next_float() * float(count_)), count - 1);
    std::rotate(chosen_.begin(), chosen_.begin() + std::ptrdiff_t(first), chosen_.end());
    if (const auto stays = float(sum / double(rare)); stays < 1.0f)
        for (ScatteringPoint& point : chosen_)
            point.weight = rng_.next_float() < stays ? point.weight / stays : Rgb(0.0f);
    return chosen_;
}

}  // namespace mote::core
