// The light of selected virtual point lights at the receivers of a tile, with what selecting works with.
#pragma once

#include "integrators/virtual_point_lights/tile_resampling.h"
#include "integrators/virtual_point_lights/vpl_selection.h"
#include "lights/selection/light_sampler.h"

namespace mote::integrators {

class TileSelection {
  public:
    /// All of `by` null: all lights are looked at, and nothing here does anything.
    TileSelection(const SelectionSettings& settings, const SelectedBy& by, const lights::VplSet& vpls,
                  float bound)
        : settings_(settings), hierarchy_(by.hierarchy), tree_(by.tree), matrix_(by.matrix), bound_(bound) {
        if (settings.resamples() && (by.tree || by.power)) resampling_.emplace(settings, by, vpls, bound);
        if (hierarchy_ && settings.cuts()) cut_.emplace(vpls, *hierarchy_, bound, settings.cut);
    }

    /// Other draws for the same eye paths: for studies of what drawing does.
    void draw_apart(std::uint64_t key) { draws_ = core::hash_keys(draws_, key); }
    bool active() const { return hierarchy_ || tree_ || matrix_ || resampling_; }
    bool collects() const { return active() && settings_.collects(); }
    bool cuts() const { return cut_.has_value(); }

    /// Unbiased: lights for all receivers of a tile. `key` determines what is drawn. Where a hierarchy is
    /// given and not to be used, all of its lights.
    lights::DrawnVpls drawn(const lights::ReceiverLanes& receivers, std::uint64_t key) {
        core::Rng rng(core::hash_keys(key, draws_));
        if (matrix_) return {matrix_->draw(receivers, rng, columns_)};
        if (!settings_.selects()) return {all()};
        const lights::ReceiverGroups groups(lights::ReceiverBounds(receivers), *tree_);
        sampler_.use(settings_.learning ? &learned_[is_in_medium(receivers)] : nullptr);
        if (settings_.kind == SelectionSettings::Kind::stochastic)
            return {sampler_.by_cut(*tree_, groups, bound_, settings_.samples, rng)};
        return {sampler_.by_tree(*tree_, groups, bound_, settings_.samples, rng)};
    }
    /// Is what drawn lights bring to be told to those of later tiles?
    bool learns() const { return tree_ && settings_.learning && settings_.draws(); }
    /// The light of drawn() at the same receivers, from which later tiles learn.
    lights::TileLight gather(const lights::GatherContext& context, const lights::VplSet& vpls,
                             const lights::DrawnVpls& drawn, lights::ReceiverTile& receivers) {
        lights::TracedVisibility visibility(context, receivers);
        std::size_t next = 0;  // drawn light: those that send nothing are not heard of
        const auto hear = [&](const lights::LaneLight& light) {
            while (drawn.drawn[next].index != light.vpl) sampler_.learn(next++, 0.0);
            double arrived = 0.0;
            for (int i = 0; i < lights::LaneLight::width; ++i)
                arrived += double(light.r[i] + light.g[i] + light.b[i]);
            sampler_.learn(next++, arrived / 3.0);
        };
        const auto sum = lights::gather_with(context, vpls, drawn, lights::BoundedGeometry{bound_}, receivers,
                                             visibility, hear);
        while (receivers.any_active && next < drawn.drawn.size()) sampler_.learn(next++, 0.0);
        return sum;
    }

    /// Lightcuts at one tile.
    lights::TileLight cut(const lights::GatherContext& context, const lights::ReceiverTile& receivers,
                          std::uint64_t key) {
        const bool medium = is_in_medium(receivers);
        points_.clear();
        points_.add(receivers, medium ? lights::GatherKind::medium : lights::GatherKind::surface);
        return gather_points(context, key)[medium];
    }

    /// Remembers points of a pixel, until gather_points(). `is_surface(lane)` tells the kinds apart.
    template <typename IsSurface>
    void collect(const lights::ReceiverTile& receivers, const IsSurface& is_surface) {
        using lights::GatherKind;
        for (const GatherKind kind : {GatherKind::surface, GatherKind::medium}) {
            lights::ReceiverTile tile = receivers;
            tile.any_active = tile.any_directional = false;
            for (int i = 0; i < lights::ReceiverTile::width; ++i)
                if (tile.max_vpl_depth[i] != 0 && is_surface(i) == (kind == GatherKind::surface))
                    tile.any_active = true, tile.any_directional |= tile.directional[i] != nullptr;
                else
                    tile.max_vpl_depth[i] = 0, tile.directional[i] = nullptr;
            if (resampling_)
                resampling_->add(tile, kind);
            else
                points_.add(tile, kind);
        }
    }
    /// Multidimensional lightcuts, or resampling, over all points since the last call, by kind.
    lights::Lightcut::Light gather_points(const lights::GatherContext& context, std::uint64_t key) {
        core::Rng rng(core::hash_keys(key, draws_));
        if (resampling_) return resampling_->gather(context, rng);
        points_.build(rng);
        const auto light = cut_->gather(context, points_, rng);
        points_.clear();
        return light;
    }

    lights::LightcutCounters counters() const { return cut_ ? cut_->counters() : lights::LightcutCounters{}; }
    lights::ResamplingCounters resampling_counters() const {
        return resampling_ ? resampling_->counters() : lights::ResamplingCounters{};
    }

  private:
    static bool is_in_medium(const lights::ReceiverLanes& receivers) {
        int lane = 0;
        while (lane + 1 < lights::ReceiverLanes::width && receivers.max_vpl_depth[lane] == 0) ++lane;
        return receivers.in_medium[lane] != 0.0f;
    }
    std::span<const lights::WeightedVpl> all() {
        if (all_.empty())
            for (const std::uint32_t light : hierarchy_->lights(hierarchy_->root())) all_.push_back({light});
        return all_;
    }

    std::uint64_t draws_ = 0x73656c656374ull;  ///< apart from what eye paths draw

    const SelectionSettings& settings_;
    const lights::LightHierarchy* hierarchy_;
    const lights::LightTree* tree_;
    const lights::MatrixSelection* matrix_;
    std::vector<lights::WeightedVpl> columns_;  ///< that stand for all, at a tile
    float bound_;
    lights::LightSampler sampler_;
    std::array<lights::LearnedShares, 2> learned_;  ///< at surfaces, in media: of this task
    std::vector<lights::WeightedVpl> all_;
    lights::GatherPoints points_;
    std::optional<lights::Lightcut> cut_;
    std::optional<TileResampling> resampling_;
};

}  // namespace mote::integrators
