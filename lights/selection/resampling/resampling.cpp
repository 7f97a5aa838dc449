#include "lights/selection/resampling/resampling.h"

namespace mote::lights {

using namespace core;

/// Targets of all pairs of a candidate and a point where any lane receives light.
void Resampling::evaluate(const GatherContext& context, std::span<const WeightedVpl> candidates) {
    pairs_.clear(), weights_.clear();
    found_.assign(candidates.size(), {});
    // Point by point: even steps through all pairs distribute the choices over the points.
    for (std::size_t p = 0; p < targets_.size(); ++p) {
        const ResamplingTarget& target = targets_[p];
        context.cancelled.check();
        if (p == 0 || target.medium() != targets_[p - 1].medium()) {
            extinctions_.clear();
            for (const WeightedVpl& light : candidates)
                extinctions_.push_back(target.extinction_at(vpls_.lights[light.index].position));
        }
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            Lanes& weights = weights_.emplace_back();
            if (!target.of_light(candidates[c], extinctions_[c], context.scratch, weights)) {
                weights_.pop_back();
                continue;
            }
            pairs_.push_back({std::uint32_t(candidates[c].index), std::uint32_t(p), std::uint32_t(c),
                              candidates[c].weight});
            float sum = 0.0f;
            for (const float w : weights) sum += w;
            found_[c].light += double(sum);
            if (!visibilities_.empty())
                for (float& w : weights) w *= visibilities_[c];
        }
    }
    counters_.candidates += candidates.size() * targets_.size();
}

/// The choices of one round and their shadow rays, a lane each.
void Resampling::fill(std::size_t round, ShadowPacket& packet, Samples& samples) {
    for (std::size_t i = 0; i < std::size_t(width); ++i) {
        Sample& s = samples[i];
        s.active = round < choice_.chosen[i].size();
        packet.t_min[i] = 0.0f, packet.t_max[i] = -1.0f;
        if (!s.active) continue;
        const ChosenCandidate& chosen = choice_.chosen[i][round];
        const Pair& pair = pairs_[chosen.candidate];
        s.point = pair.point, s.candidate = pair.candidate;
        const float weight = weights_[chosen.candidate][i];
        // W = S / (n p_hat), and v_c = w_c p_hat
        s.weight =
            choice_.sum[i] * double(chosen.count) / double(samples_) * (double(pair.weight) / double(weight));
        const ResamplingTarget::Connection c = targets_[pair.point].of_lane(int(i), pair.light);
        s.light = c.light;
        s.value = weight / (pair.weight * (visibilities_.empty() ? 1.0f : visibilities_[pair.candidate]));
        s.active = c.value > 0.0f;
        if (!s.active) continue;
        packet.set_segment(i, c.origin, c.target);
        ++counters_.chosen;
    }
}

TileLight Resampling::connect(const GatherContext& context, std::span<RecordedReceivers* const> points,
                              Rng& rng) {
    Lanes u;
    for (float& number : u) number = rng.next_float();
    choice_.choose(weights_, samples_, u);
    std::size_t rounds = 0;
    for (const auto& chosen : choice_.chosen) rounds = std::max(rounds, chosen.size());
    const bool attenuates = context.scene.attenuates();
    sums_.assign(points.size(), {});
    rounds_.resize(rounds);
    for (std::size_t first = 0; first < rounds; first += GatherScratch::batch) {
        context.cancelled.check();
        const std::size_t count = std::min(GatherScratch::batch, rounds - first);
        const auto packets = std::span(context.scratch.packets).first(count);
        for (std::size_t r = 0; r < count; ++r) fill(first + r, packets[r], rounds_[first + r]);
        context.rays.occlusion += count_rays(packets);
        context.scene.find_occluded(packets);
        for (std::size_t r = 0; r < count; ++r)
            for (int i = 0; i < width; ++i) {
                Sample& s = rounds_[first + r][std::size_t(i)];
                if (!s.active) continue;
                s.active = !packets[r].occluded(i);
                if (s.active && attenuates)
                    s.light *= lane_transmittance(context, points[s.point]->tile, i, packets[r]);
                const float passed = s.active ? luminance(s.light) / s.value : 0.0f;
                found_[s.candidate].rays += 1.0f, found_[s.candidate].ray_squares += passed * passed;
            }
        for (std::size_t r = 0; r < count; ++r)
            for (std::size_t i = 0; i < std::size_t(width); ++i)
                if (const Sample& s = rounds_[first + r][i]; s.active)
                    sums_[s.point][i] += s.weight * Vec3d(s.light);
    }
    TileLight light{};
    for (std::size_t p = 0; p < sums_.size(); ++p) {
        const TileLight one = light_of(p);
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += one[i];
    }
    return light;
}

std::vector<ChosenVpl> Resampling::chosen(int lane) const {
    const auto i = std::size_t(lane);
    std::vector<ChosenVpl> list;
    for (std::size_t round = 0; round < choice_.chosen[i].size(); ++round) {
        const Sample& s = rounds_[round][i];
        list.push_back({pairs_[choice_.chosen[i][round].candidate].light, float(s.weight), 0,
                        s.active ? Rgb(s.weight * Vec3d(s.light)) : Rgb(0.0f)});
    }
    return list;
}

TileLight Resampling::light_of(std::size_t point) const {
    TileLight light;
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = Rgb(sums_[point][i]);
    return light;
}

TileLight Resampling::gather(const GatherContext& context, std::span<RecordedReceivers* const> points,
                             std::span<const WeightedVpl> candidates, Rng& rng,
                             std::span<const float> visibilities) {
    targets_.clear();
    for (const RecordedReceivers* p : points)
        targets_.emplace_back(vpls_, p->tile, bound_, context.scene.attenuates());
    visibilities_ = visibilities;
    evaluate(context, candidates);
    return connect(context, points, rng);
}

}  // namespace mote::lights
