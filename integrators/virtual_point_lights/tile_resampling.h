// Resampled virtual point lights at the receivers of a tile: points of surfaces one after the other, each
// with what the tile before has chosen, and all points in media of an eye ray at once. Candidates drawn by
// the tree are those of all points of a pixel, and learn from the tiles before (learned_shares.h).
#pragma once

#include <algorithm>
#include <deque>

#include "core/math/morton.h"
#include "integrators/virtual_point_lights/selected_by.h"
#include "integrators/virtual_point_lights/vpl_selection.h"
#include "lights/selection/gather_points.h"
#include "lights/selection/group_candidates.h"
#include "lights/selection/light_sampler.h"
#include "lights/selection/resampling.h"

namespace mote::integrators {

class TileResampling {
  public:
    /// `by` has what the proposal of candidates needs.
    TileResampling(const SelectionSettings& settings, const SelectedBy& by, const lights::VplSet& vpls,
                   float bound)
        : settings_(settings),
          by_(by),
          vpls_(vpls),
          bound_(bound),
          resampling_(vpls, bound, settings.samples, settings.resampling.reuse) {}

    /// Remembers points of a pixel, until gather(). Idle lanes are allowed.
    void add(const lights::ReceiverTile& receivers, lights::GatherKind kind) {
        Points& points = points_[std::size_t(kind)];
        if (!receivers.any_active) return;
        if (points.used == points.tiles.size()) points.tiles.emplace_back();
        points.tiles[points.used++].keep(receivers);
    }

    /// The light at all points since the last call, by kind.
    lights::Lightcut::Light gather(const lights::GatherContext& context, core::Rng& rng) {
        lights::Lightcut::Light light{};
        auto& [surfaces, media] = points_;
        if (settings_.resampling.by_tree() && settings_.resampling.reuse == lights::SpatialReuse::none) {
            gather_all(context, rng, light);
            surfaces.used = media.used = 0;
            return light;
        }
        for (std::size_t p = 0; p < surfaces.used; ++p) {
            lights::KeptReceivers& tile = surfaces.tiles[p];
            draw(lights::ReceiverBounds(tile.tile), rng);
            const auto one = resampling_.gather_reusing(context, tile, candidates_, rng);
            for (std::size_t i = 0; i < one.size(); ++i) light[0][i] += one[i];
        }
        if (media.used > 0) {
            std::vector<lights::KeptReceivers*> along;
            for (std::size_t p = 0; p < media.used; ++p) along.push_back(&media.tiles[p]);
            lights::ReceiverBounds bounds(along[0]->tile);
            for (std::size_t p = 1; p < along.size(); ++p)
                bounds = lights::ReceiverBounds(bounds, lights::ReceiverBounds(along[p]->tile));
            draw(bounds, rng);
            light[1] = resampling_.gather(context, along, candidates_, rng);
        }
        surfaces.used = media.used = 0;
        return light;
    }
    lights::ResamplingCounters counters() const { return resampling_.counters(); }

  private:
    using Proposal = ResamplingSettings::Proposal;
    /// Of a cut. Each looks at the lights of its group, so more of them cost less than groups do, and know
    /// less.
    static constexpr std::uint32_t lights_a_group = 2;
    struct Points {
        std::deque<lights::KeptReceivers> tiles;  ///< memory that is used again
        std::size_t used = 0;
    };

    /// One set of candidates for all points.
    void gather_all(const lights::GatherContext& context, core::Rng& rng, lights::Lightcut::Light& light) {
        all_.clear(), bounds_.clear();
        for (Points& points : points_)
            for (std::size_t p = 0; p < points.used; ++p) {
                all_.push_back(&points.tiles[p]);
                bounds_.emplace_back(points.tiles[p].tile);
            }
        if (all_.empty()) return;
        sampler_.use(settings_.learning ? &learned_ : nullptr);
        draw(lights::ReceiverGroups(bounds_, *by_.tree), rng);
        seen_.clear();
        for (const std::uint32_t c : order_) seen_.push_back(sampler_.seen(c));
        resampling_.gather(context, all_, candidates_, rng, seen_);
        for (std::size_t p = 0; p < all_.size(); ++p) {
            const auto one = resampling_.light_of(p);
            auto& sum = light[p < points_[0].used ? 0 : 1];
            for (std::size_t i = 0; i < one.size(); ++i) sum[i] += one[i];
        }
        if (!settings_.learning) return;
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            const auto& found = resampling_.found()[c];
            sampler_.learn(order_[c], found.light, found.rays, found.ray_squares);
        }
    }

    void draw(const lights::ReceiverGroups& groups, core::Rng& rng) {
        const std::uint32_t n = settings_.resampling.candidates;
        const auto drawn = settings_.resampling.proposal == Proposal::cut
                               ? sampler_.from_groups(*by_.tree, groups, bound_,
                                                      std::max(n / lights_a_group, 1u), lights_a_group, rng)
                               : sampler_.by_tree(*by_.tree, groups, bound_, n, rng);
        candidates_.assign(drawn.begin(), drawn.end());
        sort_by_place();
    }

    void draw(const lights::ReceiverBounds& receivers, core::Rng& rng) {
        const std::uint32_t n = settings_.resampling.candidates;
        candidates_.clear();
        if (settings_.resampling.proposal == Proposal::power) {
            by_.power->draw(n, rng, candidates_);
            return;
        }
        if (settings_.resampling.proposal == Proposal::groups) {
            groups_.draw(*by_.hierarchy, *by_.power, receivers, bound_, n, rng, candidates_);
            sort_by_place();
            return;
        }
        draw(lights::ReceiverGroups(receivers, *by_.tree), rng);
    }

    /// Choices are even steps through the candidates: where neighbours are alike they are spread evenly over
    /// the lights. By power candidates come in the order of the hierarchy.
    void sort_by_place() {
        core::Bounds3 bounds;
        for (const lights::WeightedVpl& c : candidates_) bounds.extend(vpls_.lights[c.index].position);
        keys_.clear();
        for (std::size_t c = 0; c < candidates_.size(); ++c)
            keys_.emplace_back(core::morton_code(vpls_.lights[candidates_[c].index].position, bounds),
                               std::uint32_t(c));
        unsorted_.assign(candidates_.begin(), candidates_.end());
        std::sort(keys_.begin(), keys_.end(), [&](const auto& a, const auto& b) {
            if (a.first != b.first) return a.first < b.first;
            return unsorted_[a.second].index < unsorted_[b.second].index;
        });
        order_.clear();
        for (std::size_t i = 0; i < keys_.size(); ++i)
            order_.push_back(keys_[i].second), candidates_[i] = unsorted_[keys_[i].second];
    }

    const SelectionSettings& settings_;
    const SelectedBy by_;
    const lights::VplSet& vpls_;
    float bound_;
    std::array<Points, 2> points_;  ///< by kind
    lights::LightSampler sampler_;
    lights::GroupCandidates groups_;
    lights::LearnedShares learned_;  ///< of this task
    std::vector<lights::WeightedVpl> candidates_, unsorted_;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys_;
    std::vector<std::uint32_t> order_;  ///< of the candidates: as they were drawn
    std::vector<float> seen_;           ///< by candidate
    std::vector<lights::KeptReceivers*> all_;
    std::vector<lights::ReceiverBounds> bounds_;
    lights::Resampling resampling_;
};

}  // namespace mote::integrators
