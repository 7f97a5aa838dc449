#include "lights/selection/lightcuts/lightcuts_selection.h"

#include <fmt/format.h>

#include "core/parameters/add_type.h"
#include "lights/selection/hierarchy/build_statistics.h"
#include "lights/selection/hierarchy/vertex_bounds.h"

namespace mote::lights {

using namespace core;

namespace {

class TileLightcuts final : public TileSelector {
  public:
    TileLightcuts(const VplSet& vpls, const LightHierarchy& lights, float bound,
                  const LightcutSettings& settings, bool multidimensional)
        : cut_(vpls, lights, bound, settings), multidimensional_(multidimensional) {}

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

    GatherPoints points_;
    Lightcut cut_;
    bool multidimensional_;
};

class LightcutsSelector final : public VplSelector {
  public:
    LightcutsSelector(const SelectionPass& pass, const LightcutSettings& settings, bool multidimensional)
        : vpls_(pass.vpls), bound_(pass.bound), settings_(settings), multidimensional_(multidimensional) {
        const BuildStatistics timer(pass.statistics, "light_hierarchy");
        lights_ = LightHierarchy(leaves_);
        timer.built(lights_.memory_bytes());
    }
    std::unique_ptr<TileSelector> for_task() const override {
        return std::make_unique<TileLightcuts>(vpls_, lights_, bound_, settings_, multidimensional_);
    }

  private:
    const VplSet& vpls_;
    float bound_;
    LightcutSettings settings_;
    bool multidimensional_;
    VplLeaves leaves_{vpls_};
    LightHierarchy lights_;
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

}  // namespace

std::unique_ptr<VplSelector> LightcutsSelection::prepare(const SelectionPass& pass) const {
    check_memory(pass);
    return std::make_unique<LightcutsSelector>(pass, settings_, multidimensional_);
}

std::string LightcutsSelection::excludes(const GatherOptions& options) const {
    if (options.interleaving) return "interleaving";  // neighbouring pixels are needed in one tile
    const std::string other = Selection::excludes(options);
    return other.empty() && options.imperfect_shadow_maps ? "imperfect shadow maps" : other;
}

std::size_t LightcutsSelection::memory_bytes(std::size_t vpls) const {
    return vpls * (LightHierarchy::bytes_a_light + LightHierarchy::building_bytes_a_light);
}

void LightcutsSelection::plan(Plan& plan, const SelectionSize& size) const {
    plan.run("selection",
             fmt::format("{}lightcuts, threshold {:g} %, at most {} clusters",
                         multidimensional_ ? "multidimensional " : "", 100.0 * double(settings_.threshold),
                         settings_.max_cut),
             "biased by at most the threshold for each cluster; one cut a tile of 4 x 4");
    plan_memory(plan, "memory of the light hierarchy", size);
}

void register_lightcuts(Registry& registry) {
    const auto add = [&](const std::string& type, const std::string& summary, bool multidimensional) {
        add_type(registry, Category::selection, type, summary, parameters,
                 "<selection type=\"" + type + "\"/>",
                 [multidimensional](const LightcutSettings& settings, const Properties& properties) {
                     const auto selection = std::make_shared<LightcutsSelection>(settings, multidimensional);
                     selection->where = properties.where;
                     return selection;
                 });
    };
    add("lightcuts",
        "Lightcuts (Walter et al. 2005): clusters of VPLs, each by its representative, refined until their "
        "largest error bound is below a threshold.",
        false);
    add("multidimensional_lightcuts",
        "Lightcuts over all points of a pixel at once (Walter et al. 2006): along its eye rays through "
        "media, on the surface behind them, and of all its eye paths.",
        true);
}

}  // namespace mote::lights
