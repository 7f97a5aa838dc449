#include "lights/selection/lightcut.h"

#include <algorithm>
#include <limits>

namespace mote::lights {

using namespace core;

namespace {

/// Pairs parted at once: few enough to part the worst first, enough for batches of shadow rays.
constexpr std::size_t least_parted = GatherScratch::batch;

}  // namespace

void Lightcut::add_to_total(const Estimate& e, double sign) {
    for (std::size_t i = 0; i < total_.size(); ++i)
        total_[i] += sign * (double(e.r[i]) + double(e.g[i]) + double(e.b[i])) * (1.0 / 3.0);
}

/// A pair is exact where both groups hold one: its error is 0.
void Lightcut::set_pair(GatherPoints& points, std::size_t index, const Pair& pair) {
    const GatherGroup& group = points.group(pair.group);
    pairs_[index] = pair;
    errors_[index] = expected_[index] = {};
    if (pair.lights.single() && group.single()) return;
    const LightNode node = lights_.node(pair.lights);
    errors_[index] = most_light(node, group.bounds, bound_.bound);
    expected_[index] = expected_light(node, group.bounds, bound_.bound);
}

void Lightcut::add_pair(GatherPoints& points, const Pair& pair) {
    const std::size_t index = pairs_.size();
    pairs_.emplace_back(), errors_.emplace_back(), expected_.emplace_back(), estimates_.emplace_back();
    set_pair(points, index, pair);
    waiting_.push_back(std::uint32_t(index));
}

void Lightcut::scale_estimate(std::size_t index, float scale) {
    Estimate& e = estimates_[index];
    add_to_total(e, -1.0);
    for (int i = 0; i < width; ++i) e.r[i] *= scale, e.g[i] *= scale, e.b[i] *= scale;
    add_to_total(e, 1.0);
}

/// The light that stands for both stands for one part still, with a smaller weight; the other has its own.
void Lightcut::part_lights(GatherPoints& points, std::size_t index) {
    const Pair pair = pairs_[index];
    const LightCluster left = lights_.left(pair.lights), right = lights_.right(pair.lights);
    const std::uint32_t place = lights_.representative(pair.lights);
    const bool in_left = place < right.first;
    const LightCluster &heir = in_left ? left : right, &other = in_left ? right : left;
    scale_estimate(index, lights_.weight(heir) / lights_.weight(pair.lights));
    set_pair(points, index, {pair.group, heir, pair.kind});
    add_pair(points, {pair.group, other, pair.kind});
}

/// Who stands for the points of a lane is one of its left or of its right points, which differs from lane to
/// lane.
void Lightcut::part_points(GatherPoints& points, std::size_t index) {
    const Pair pair = pairs_[index];
    const GatherGroup& group = points.group(pair.group);
    add_to_total(estimates_[index], -1.0);
    estimates_[index] = {};
    set_pair(points, index, {group.left, pair.lights, pair.kind});
    waiting_.push_back(std::uint32_t(index));
    add_pair(points, {group.right, pair.lights, pair.kind});
}

void Lightcut::part(GatherPoints& points, std::size_t index) {
    const Pair& pair = pairs_[index];
    const GatherGroup& group = points.group(pair.group);
    const bool lights_first =
        pair.lights.single() ? false
                             : group.single() || lights_.node(pair.lights).diagonal2() >= group.diagonal2;
    if (lights_first)
        part_lights(points, index);
    else
        part_points(points, index);
}

/// Estimates of the pairs of batch_, whose light and rays are in the scratch memory.
void Lightcut::resolve(const GatherContext& context, GatherPoints& points) {
    context.cancelled.check();
    const auto packets = std::span(context.scratch.packets).first(in_batch_);
    const auto light = std::span(context.scratch.light).first(in_batch_);
    context.rays.occlusion += count_rays(packets);
    context.scene.find_occluded(packets);
    for (std::size_t k = 0; k < in_batch_; ++k) {
        const std::size_t index = batch_[k];
        ReceiverTile& tile = points.group(pairs_[index].group).representative;
        attenuate_free(context, tile, packets.subspan(k, 1), light.subspan(k, 1));
        Estimate& e = estimates_[index];
        std::copy_n(light[k].r, width, e.r), std::copy_n(light[k].g, width, e.g);
        std::copy_n(light[k].b, width, e.b);
        add_to_total(e, 1.0);
    }
    in_batch_ = 0;
}

/// Of all pairs that wait.
void Lightcut::evaluate(const GatherContext& context, GatherPoints& points) {
    for (const std::uint32_t index : waiting_) {
        const Pair& pair = pairs_[index];
        const std::uint32_t place = lights_.representative(pair.lights);
        const float weight = lights_.weight(pair.lights) / lights_.weight_at(place);
        const ReceiverTile& tile = points.group(pair.group).representative;
        estimates_[index] = {};
        if (!contributions_of(vpls_, {lights_.light_at(place), weight}, tile, bound_,
                              context.scratch.packets[in_batch_], context.scratch.light[in_batch_]))
            continue;
        batch_[in_batch_++] = index;
        if (in_batch_ == GatherScratch::batch) resolve(context, points);
    }
    if (in_batch_ > 0) resolve(context, points);
    counters_.evaluated += waiting_.size();
    waiting_.clear();
}

/// The pairs to part now into worst_, its first `count`.
void Lightcut::find_worst(std::size_t& count) {
    constexpr float most = std::numeric_limits<float>::max();
    alignas(64) float inverse[width];
    for (int i = 0; i < width; ++i) {
        const double allowed = double(settings_.threshold) * std::max(total_[std::size_t(i)], 0.0);
        inverse[i] = allowed > 0.0 ? float(std::min(1.0 / allowed, double(most))) : most;
    }
    worst_.clear();
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        float error = 0.0f, expected = 0.0f;
        for (int i = 0; i < width; ++i) {
            error = core::max_of(error, errors_[p].value[std::size_t(i)] * inverse[i]);
            expected = core::max_of(expected, expected_[p].value[std::size_t(i)] * inverse[i]);
        }
        if (error > 1.0f) worst_.push_back({expected, std::uint32_t(p)});
    }
    const std::size_t room = settings_.max_cut - std::min<std::size_t>(settings_.max_cut, pairs_.size());
    count = std::min({worst_.size(), room, std::max(least_parted, worst_.size() / 2)});
    if (count < worst_.size())
        std::nth_element(worst_.begin(), worst_.begin() + std::ptrdiff_t(count), worst_.end(),
                         [](const Worst& a, const Worst& b) {
                             return a.expected != b.expected ? a.expected > b.expected : a.pair < b.pair;
                         });
}

Lightcut::Light Lightcut::gather(const GatherContext& context, GatherPoints& points) {
    pairs_.clear(), errors_.clear(), expected_.clear(), estimates_.clear(), waiting_.clear();
    total_ = {};
    if (lights_.empty()) return {};
    for (const GatherKind kind : {GatherKind::surface, GatherKind::medium})
        if (points.root(kind) != GatherPoints::none)
            add_pair(points, {points.root(kind), lights_.root(), kind});
    if (pairs_.empty()) return {};
    for (std::size_t count = 0;;) {
        evaluate(context, points);
        find_worst(count);
        if (count == 0) break;
        for (std::size_t k = 0; k < count; ++k) part(points, worst_[k].pair);
    }
    ++counters_.cuts, counters_.pairs += pairs_.size(), counters_.at_limit += !worst_.empty();
    std::array<std::array<Vec3d, width>, 2> sum{};
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        auto& of_kind = sum[std::size_t(pairs_[p].kind)];
        const Estimate& e = estimates_[p];
        for (std::size_t i = 0; i < of_kind.size(); ++i) of_kind[i] += Vec3d(e.r[i], e.g[i], e.b[i]);
    }
    Light light{};
    for (std::size_t kind = 0; kind < 2; ++kind)
        for (std::size_t i = 0; i < light[kind].size(); ++i) light[kind][i] = Rgb(sum[kind][i]);
    return light;
}

}  // namespace mote::lights
