#include "lights/selection/stochastic/stochastic_selection.h"

#include <fmt/format.h>

#include "core/parameters/add_type.h"
#include "lights/selection/hierarchy/build_statistics.h"
#include "lights/selection/hierarchy/vertex_bounds.h"
#include "lights/selection/sampling_selector.h"
#include "lights/selection/stochastic/light_sampler.h"

namespace mote::lights {

using namespace core;

namespace {

class TileStochastic final : public SamplingSelector {
  public:
    TileStochastic(const VplSet& vpls, const WideLightTree& tree, float bound, std::uint32_t samples,
                   bool by_cut)
        : SamplingSelector(vpls, bound), tree_(tree), bound_(bound), samples_(samples), by_cut_(by_cut) {}

  protected:
    std::span<const WeightedVpl> sample(const ReceiverLanes& receivers, Rng& rng) override {
        const ReceiverClusters clusters(ReceiverBounds(receivers), tree_);
        sampler_.learn_into(&learned_[std::size_t(kind_of(receivers))]);
        return by_cut_ ? sampler_.by_cut(tree_, clusters, bound_, samples_, rng)
                       : sampler_.by_tree(tree_, clusters, bound_, samples_, rng);
    }
    bool learns() const override { return true; }
    void record_light(std::size_t i, double light) override { sampler_.learn(i, light); }

  private:
    const WideLightTree& tree_;
    float bound_;
    std::uint32_t samples_;
    bool by_cut_;
    LightSampler sampler_;
    std::array<LearnedImportance, 2> learned_;  ///< by ReceiverKind
};

class StochasticSelector final : public VplSelector {
  public:
    StochasticSelector(const SelectionPass& pass, std::uint32_t samples, bool by_cut)
        : vpls_(pass.vpls), bound_(pass.bound), samples_(samples), by_cut_(by_cut) {
        const BuildStatistics timer(pass.statistics, "light_hierarchy");
        tree_ = WideLightTree(VplLeaves(vpls_));
        timer.built(tree_.memory_bytes());
    }
    std::unique_ptr<TileSelector> for_task() const override {
        return std::make_unique<TileStochastic>(vpls_, tree_, bound_, samples_, by_cut_);
    }

  private:
    const VplSet& vpls_;
    float bound_;
    std::uint32_t samples_;
    bool by_cut_;
    WideLightTree tree_;
};

struct StochasticSettings {
    std::uint32_t samples = 64;
};

const ParameterList<StochasticSettings> parameters{
    row("samples", &StochasticSettings::samples, between(1, 1 << 20),
        "VPLs sampled for each tile of 4 x 4 pixels: time is in proportion to it, the variance about "
        "inversely."),
};

}  // namespace

std::unique_ptr<VplSelector> StochasticSelection::prepare(const SelectionPass& pass) const {
    check_memory(pass);
    return std::make_unique<StochasticSelector>(pass, samples_, by_cut_);
}

std::size_t StochasticSelection::memory_bytes(std::size_t vpls) const {
    return vpls * (WideLightTree::bytes_a_light + WideLightTree::building_bytes_a_light);
}

void StochasticSelection::plan(Plan& plan, const SelectionSize& size) const {
    plan.run("selection",
             by_cut_ ? fmt::format("stochastic lightcuts, {} VPLs a tile", samples_)
                     : fmt::format("{} VPLs a tile, sampled by the light tree", samples_),
             "unbiased; the same VPLs for a tile of 4 x 4");
    plan_memory(plan, "memory of the light tree", size);
}

void register_stochastic_selection(Registry& registry) {
    const auto add = [&](const std::string& type, const std::string& summary, bool by_cut) {
        add_type(registry, Category::selection, type, summary, parameters,
                 "<selection type=\"" + type + "\"/>",
                 [by_cut](const StochasticSettings& settings, const Properties& properties) {
                     const auto selection = std::make_shared<StochasticSelection>(settings.samples, by_cut);
                     selection->where = properties.where;
                     return selection;
                 });
    };
    add("stochastic_lightcuts",
        "Stochastic lightcuts (Yuksel 2019): one VPL sampled from each cluster of a cut for each tile, "
        "unbiased.",
        true);
    add("light_tree",
        "VPLs sampled by a light tree in proportion to their importance (Estevez and Kulla 2018): unbiased.",
        false);
}

}  // namespace mote::lights
