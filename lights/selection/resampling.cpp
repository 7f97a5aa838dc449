#include "lights/selection/resampling.h"

namespace mote::lights {

using namespace core;

/// Targets of all pairs of a candidate and a point where any lane receives light.
void Resampling::look(const GatherContext& context, std::span<const WeightedVpl> candidates,
                      std::span<const float> seen) {
    pairs_.clear(), weights_.clear(), shares_of_pairs_.clear();
    found_.assign(candidates.size(), {});
    // Point by point: even steps through all pairs give each point its share of the choices.
    for (std::size_t p = 0; p < targets_.size(); ++p) {
        const ResamplingTarget& target = targets_[p];
        context.cancelled.check();
        if (p == 0 || target.medium() != targets_[p - 1].medium()) {
            extinctions_.clear();
            for (const WeightedVpl& light : candidates)
                extinctions_.push_back(target.extinction_at(vpls_.lights[light.index].position));
        }
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            Weights& weights = weights_.emplace_back();
            if (!target.of_light(candidates[c], extinctions_[c], context.scratch, weights)) {
                weights_.pop_back();
                continue;
            }
            pairs_.push_back({std::uint32_t(candidates[c].index), std::uint32_t(p), std::uint32_t(c),
                              candidates[c].weight});
            float sum = 0.0f;
            for (const float w : weights) sum += w;
            found_[c].light += double(sum);
            if (!seen.empty())
                for (float& w : weights) w *= seen[c];
        }
    }
    counters_.candidates += candidates.size() * targets_.size();
}

/// Own candidates by the share of their technique.
void Resampling::share_with_neighbours(const GatherContext& context) {
    for (std::size_t c = 0; c < pairs_.size(); ++c) {
        const Pair& pair = pairs_[c];
        Weights& shares = shares_of_pairs_.emplace_back();
        Weights other{};
        if (shares_.reuse == SpatialReuse::unbiased &&
            !target_before_->of_light({pair.light}, context.scratch, other))
            other = {};
        for (std::size_t i = 0; i < std::size_t(width); ++i) {
            const float own = weights_[c][i] / pair.weight * targets_[0].scale(int(i));
            shares[i] = shares_.of_own(own, other[i] * target_before_->scale(int(i)), before_.confidence[i]);
            weights_[c][i] *= shares[i];
        }
    }
}

/// What the tile before has chosen, lane by lane.
void Resampling::add_reused() {
    std::size_t most = 0;
    for (const auto& samples : before_.samples) most = std::max(most, samples.size());
    for (std::size_t k = 0; k < most; ++k) {
        pairs_.push_back({std::uint32_t(k), 0, 0, 0.0f});
        Weights &weights = weights_.emplace_back(), &shares = shares_of_pairs_.emplace_back();
        weights = shares = {};
        for (std::size_t i = 0; i < std::size_t(width); ++i) {
            if (k >= before_.samples[i].size()) continue;
            const ReusedSample& sample = before_.samples[i][k];
            const float value = targets_[0].of_lane(int(i), sample.light).value;
            shares[i] =
                shares_.of_reused(value * targets_[0].scale(int(i)), sample.target, before_.confidence[i]);
            weights[i] = value * sample.weight * shares[i];
        }
    }
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
        s.own = pair.weight > 0.0f, s.point = pair.point, s.candidate = pair.candidate;
        s.share = reusing_ ? shares_of_pairs_[chosen.candidate][i] : 1.0f;
        s.index = s.own ? pair.light : before_.samples[i][pair.light].light;
        const float worth = s.own ? pair.weight : before_.samples[i][pair.light].weight;
        // W = S / (n p_hat), and v_c = w_c m p_hat
        s.weight = choice_.sum[i] * double(chosen.count) / double(samples_) *
                   (double(worth) * double(s.share) / double(weights_[chosen.candidate][i]));
        const ResamplingTarget& target = targets_[pair.point];
        const ResamplingTarget::Connection c =
            target.of_lane(int(i), s.index, shares_.reuse != SpatialReuse::none);
        s.light = c.light, s.target = c.value * target.scale(int(i));
        s.value = weights_[chosen.candidate][i] /
                  (worth * s.share * (seen_.empty() ? 1.0f : seen_[pair.candidate]));
        s.active = c.value > 0.0f;
        if (!s.active) continue;
        packet.origin_x[i] = c.origin.x, packet.origin_y[i] = c.origin.y, packet.origin_z[i] = c.origin.z;
        packet.direction_x[i] = c.target.x - c.origin.x, packet.direction_y[i] = c.target.y - c.origin.y;
        packet.direction_z[i] = c.target.z - c.origin.z, packet.t_max[i] = shadow_t_max;
        ++counters_.chosen, counters_.reused += !s.own;
    }
}

/// Own choices that arrive, and which the tile before could have chosen: whether it sees them.
void Resampling::look_back(const GatherContext& context, std::size_t rounds) {
    const auto packets = std::span(context.scratch.packets).first(rounds);
    bool any = false;
    for (std::size_t r = 0; r < rounds; ++r)
        for (std::size_t i = 0; i < std::size_t(width); ++i) {
            const Sample& s = batch_[r][i];
            ShadowPacket& ray = packets[r];
            ray.t_max[i] = -1.0f;
            if (!s.active || !s.own || s.share == 1.0f) continue;
            const auto c = target_before_->of_lane(int(i), s.index);
            ray.origin_x[i] = c.origin.x, ray.origin_y[i] = c.origin.y, ray.origin_z[i] = c.origin.z;
            ray.direction_x[i] = c.target.x - c.origin.x, ray.direction_y[i] = c.target.y - c.origin.y;
            ray.direction_z[i] = c.target.z - c.origin.z, ray.t_max[i] = shadow_t_max;
            any = true;
        }
    if (!any) return;
    context.rays.occlusion += count_rays(packets);
    std::array<std::array<bool, width>, GatherScratch::batch> asked;
    for (std::size_t r = 0; r < rounds; ++r)
        for (std::size_t i = 0; i < std::size_t(width); ++i) asked[r][i] = packets[r].t_max[i] > 0.0f;
    context.scene.find_occluded(packets);
    for (std::size_t r = 0; r < rounds; ++r)
        for (std::size_t i = 0; i < std::size_t(width); ++i)
            if (asked[r][i] && packets[r].occluded(int(i)))
                batch_[r][i].weight /= double(batch_[r][i].share);  // m_own is 1
}

void Resampling::remember(std::size_t rounds) {
    for (std::size_t r = 0; r < rounds; ++r)
        for (std::size_t i = 0; i < std::size_t(width); ++i)
            if (const Sample& s = batch_[r][i]; s.active)
                kept_[i].push_back({s.index, float(s.weight), s.target});
}

TileLight Resampling::connect(const GatherContext& context, std::span<KeptReceivers* const> points,
                              Rng& rng) {
    std::array<float, width> u;
    for (float& number : u) number = rng.next_float();
    choice_.choose(weights_, samples_, u);
    std::size_t rounds = 0;
    for (const auto& chosen : choice_.chosen) rounds = std::max(rounds, chosen.size());
    const bool attenuates = context.scene.attenuates();
    sums_.assign(points.size(), {});
    for (std::size_t first = 0; first < rounds; first += GatherScratch::batch) {
        context.cancelled.check();
        const std::size_t count = std::min(GatherScratch::batch, rounds - first);
        const auto packets = std::span(context.scratch.packets).first(count);
        for (std::size_t r = 0; r < count; ++r) fill(first + r, packets[r], batch_[r]);
        context.rays.occlusion += count_rays(packets);
        context.scene.find_occluded(packets);
        for (std::size_t r = 0; r < count; ++r)
            for (int i = 0; i < width; ++i) {
                Sample& s = batch_[r][std::size_t(i)];
                if (!s.active) continue;
                s.active = !packets[r].occluded(i);
                if (s.active && attenuates)
                    s.light *= lane_transmittance(context, points[s.point]->tile, i, packets[r]);
                const float passed = s.active ? luminance(s.light) / s.value : 0.0f;
                if (s.own)
                    found_[s.candidate].rays += 1.0f, found_[s.candidate].ray_squares += passed * passed;
            }
        if (reusing_ && shares_.reuse == SpatialReuse::unbiased) look_back(context, count);
        for (std::size_t r = 0; r < count; ++r)
            for (std::size_t i = 0; i < std::size_t(width); ++i)
                if (const Sample& s = batch_[r][i]; s.active) sums_[s.point][i] += s.weight * Vec3d(s.light);
        if (shares_.reuse != SpatialReuse::none) remember(count);
    }
    TileLight light{};
    for (std::size_t p = 0; p < sums_.size(); ++p) {
        const TileLight one = light_of(p);
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += one[i];
    }
    return light;
}

TileLight Resampling::light_of(std::size_t point) const {
    TileLight light;
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = Rgb(sums_[point][i]);
    return light;
}

TileLight Resampling::gather(const GatherContext& context, std::span<KeptReceivers* const> points,
                             std::span<const WeightedVpl> candidates, Rng& rng, std::span<const float> seen) {
    targets_.clear();
    for (const KeptReceivers* p : points)
        targets_.emplace_back(vpls_, p->tile, bound_, context.scene.attenuates(), false);
    seen_ = seen;
    look(context, candidates, seen);
    reusing_ = false;
    const TileLight light = connect(context, points, rng);
    for (auto& samples : kept_) samples.clear();
    return light;
}

TileLight Resampling::gather_reusing(const GatherContext& context, KeptReceivers& tile,
                                     std::span<const WeightedVpl> candidates, Rng& rng) {
    KeptReceivers* const points[] = {&tile};
    if (shares_.reuse == SpatialReuse::none) return gather(context, points, candidates, rng);
    targets_.clear();
    targets_.emplace_back(vpls_, tile.tile, bound_, context.scene.attenuates(), true);
    seen_ = {};
    look(context, candidates, {});
    reusing_ = before_.any;
    if (reusing_) {
        before_.keep_alike(tile.tile);
        target_before_.emplace(vpls_, before_.receivers.tile, bound_, context.scene.attenuates(), true);
        share_with_neighbours(context);
        add_reused();
    }
    const TileLight light = connect(context, points, rng);
    before_.receivers.keep(tile.tile);
    before_.count_tile(tile.tile);
    before_.samples.swap(kept_);
    for (auto& samples : kept_) samples.clear();
    return light;
}

}  // namespace mote::lights
