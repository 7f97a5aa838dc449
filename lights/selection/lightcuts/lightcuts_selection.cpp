// Lightcuts (Walter et al. 2005) and multidimensional lightcuts (Walter et al. 2006) as selections.
#include <fmt/format.h>

#include "lights/selection/hierarchy/build_statistics.h"
#include "lights/selection/hierarchy/vertex_bounds.h"
#include "lights/selection/lightcuts/lightcut.h"
#include "lights/selection/register_selection.h"

namespace mote::lights {

using namespace core;

namespace {

/// The hierarchy of a pass.
struct VplHierarchy {
    explicit VplHierarchy(const VplSet& vpls) : leaves(vpls), lights(leaves) {}
    VplLeaves leaves;
    LightHierarchy lights;
};

class TileLightcuts final : public TileSelector {
  public:
    TileLightcuts(const VplSet& vpls, std::shared_ptr<const VplHierarchy> hierarchy, float bound,
                  const LightcutSettings& settings, bool multidimensional)
        : hierarchy_(std::move(hierarchy)),
          cut_(vpls, hierarchy_->lights, bound, settings),
          multidimensional_(multidimensional) {}

    std::size_t max_points() const override {
        return multidimensional_ ? std::size_t(-1) : TileSelector::max_points();
    }
    TileLight gather(const GatherContext& context, ReceiverTile& receivers, const VplRange&, BatchVisibility&,
                     Rng& rng) override {
        if (multidimensional_) {
            for (const ReceiverKind kind : {ReceiverKind::surface, ReceiverKind::medium})
                points_.add(lanes_of(receivers, kind), kind);
            return {};
        }
        if (!receivers.any_active) return {};
        const ReceiverKind kind = kind_of(receivers);
        points_.clear();
        points_.add(receivers, kind);
        return gather_points(context, rng)[std::size_t(kind)];
    }
    LightByKind gather_copied(const GatherContext& context, Rng& rng) override {
        return multidimensional_ ? gather_points(context, rng) : LightByKind{};
    }
    std::vector<ChosenVpl> chosen(int lane) const override { return cut_.chosen(lane); }
    void add_statistics(Statistics& statistics) const override {
        const LightcutCounters& c = cut_.counters();
        if (c.cuts == 0) return;
        statistics.values["lightcuts"] += double(c.cuts);
        statistics.values["lightcut_pairs"] += double(c.pairs);
        statistics.values["lightcut_pairs_evaluated"] += double(c.evaluated);
        statistics.values["lightcuts_at_limit"] += double(c.at_limit);
        statistics.values["lightcut_predicted_squares"] += c.predicted_squares;
    }

  private:
    LightByKind gather_points(const GatherContext& context, Rng& rng) {
        Rng choices = choices_of(rng);
        points_.build(choices);
        const LightByKind light = cut_.gather(context, points_, choices);
        points_.clear();
        return light;
    }

    std::shared_ptr<const VplHierarchy> hierarchy_;
    GatherPoints points_;
    Lightcut cut_;
    bool multidimensional_;
};

const ParameterList<LightcutSettings> parameters{
    row("threshold", &LightcutSettings::threshold, between(0, 1),
        "Upper bound of the error of one cluster, relative to a pixel's light. Lower: less error, for time "
        "about in proportion to the clusters. 0: all VPLs."),
    row("max_cut", &LightcutSettings::max_cut, between(1, 1 << 28),
        "Largest number of clusters that light a tile of 4 x 4 pixels: bounds the time."),
    row("error", &LightcutSettings::error, between(0, 1),
        "Refinement also ends where the estimated relative RMSE of a tile falls below this. 0: by threshold "
        "alone."),
    row("shared_angle", &LightcutSettings::shared_angle, between(0, 10, "rad"),
        "Points on a face, or beside each other in a medium, that a VPL sees within such an angle share a "
        "shadow ray: 0.2 halves the time and adds a tenth of the error. 0: none do."),
};

class LightcutsSelection final : public Selection {
  public:
    /// `multidimensional`: one cut for all points of a pixel, else one for each.
    LightcutsSelection(const LightcutSettings& settings, bool multidimensional)
        : settings_(settings), multidimensional_(multidimensional) {}
    VplSelector prepare(const SelectionPass& pass) const override {
        check_memory(pass);
        const BuildStatistics timer(pass.statistics, "light_hierarchy");
        const auto hierarchy = std::make_shared<const VplHierarchy>(pass.vpls);
        timer.built(hierarchy->lights.memory_bytes());
        return [hierarchy, &vpls = pass.vpls, bound = pass.bound, *this] {
            return std::make_unique<TileLightcuts>(vpls, hierarchy, bound, settings_, multidimensional_);
        };
    }
    std::string excludes(const GatherOptions& options) const override {
        if (options.interleaving) return "interleaving";  // neighbouring pixels are needed in one tile
        const std::string other = Selection::excludes(options);
        return other.empty() && options.imperfect_shadow_maps ? "imperfect shadow maps" : other;
    }
    std::size_t memory_bytes(std::size_t vpls) const override {
        return vpls * (LightHierarchy::bytes_a_light + LightHierarchy::building_bytes_a_light);
    }
    void plan(Plan& plan, const SelectionSize& size) const override {
        plan.run("selection",
                 fmt::format("{}lightcuts, threshold {:g} %, at most {} clusters",
                             multidimensional_ ? "multidimensional " : "",
                             100.0 * double(settings_.threshold), settings_.max_cut),
                 "biased by at most the threshold for each cluster; one cut a tile of 4 x 4");
        plan_memory(plan, "memory of the light hierarchy", size);
    }

  private:
    LightcutSettings settings_;
    bool multidimensional_;
};

}  // namespace

void register_lightcuts(Registry& registry) {
    add_selection<LightcutsSelection>(
        registry, "lightcuts",
        "Lightcuts (Walter et al. 2005): clusters of VPLs, each by its representative, refined until their "
        "largest error bound is below a threshold.",
        parameters, false);
    add_selection<LightcutsSelection>(
        registry, "multidimensional_lightcuts",
        "Lightcuts over all points of a pixel at once (Walter et al. 2006): along its eye rays through "
        "media, on the surface behind them, and of all its eye paths.",
        parameters, true);
}

}  // namespace mote::lights
