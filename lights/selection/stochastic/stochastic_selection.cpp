// Stochastic lightcuts (Yuksel 2019) and sampling by a light tree (Estevez and Kulla 2018) as selections.
#include <fmt/format.h>

#include "lights/selection/register_selection.h"
#include "lights/selection/sampling_selector.h"
#include "lights/selection/stochastic/light_sampler.h"
#include "lights/selection/tree_selection.h"

namespace mote::lights {

using namespace core;

namespace {

class TileStochastic final : public SamplingSelector {
  public:
    TileStochastic(const VplSet& vpls, std::shared_ptr<const WideLightTree> tree, float bound,
                   std::uint32_t samples, bool by_cut)
        : SamplingSelector(vpls, bound),
          tree_(std::move(tree)),
          bound_(bound),
          samples_(samples),
          by_cut_(by_cut) {}

  protected:
    std::span<const WeightedVpl> sample(const ReceiverLanes& receivers, Rng& rng) override {
        const ReceiverClusters clusters(ReceiverBounds(receivers), *tree_);
        sampler_.learn_into(&learned_[std::size_t(kind_of(receivers))]);
        return by_cut_ ? sampler_.by_cut(*tree_, clusters, bound_, samples_, rng)
                       : sampler_.by_tree(*tree_, clusters, bound_, samples_, rng);
    }
    bool learns() const override { return true; }
    void record_light(std::size_t i, double light) override { sampler_.learn(i, light); }

  private:
    std::shared_ptr<const WideLightTree> tree_;
    float bound_;
    std::uint32_t samples_;
    bool by_cut_;
    LightSampler sampler_;
    std::array<LearnedImportance, 2> learned_;  ///< by ReceiverKind
};

struct StochasticSettings {
    std::uint32_t samples = 64;
};

const ParameterList<StochasticSettings> parameters{
    row("samples", &StochasticSettings::samples, between(1, 1 << 20),
        "VPLs sampled for each tile of 4 x 4 pixels: time is in proportion to it, the variance about "
        "inversely."),
};

class StochasticSelection final : public TreeSelection {
  public:
    /// VPLs from the clusters of a cut, or each from the root of the tree.
    StochasticSelection(const StochasticSettings& settings, bool by_cut)
        : samples_(settings.samples), by_cut_(by_cut) {}
    bool is_unbiased() const override { return true; }
    VplSelector prepare(const SelectionPass& pass) const override {
        return [tree = build_tree(pass), &vpls = pass.vpls, bound = pass.bound, samples = samples_,
                by_cut = by_cut_] {
            return std::make_unique<TileStochastic>(vpls, tree, bound, samples, by_cut);
        };
    }
    void plan(Plan& plan, const SelectionSize& size) const override {
        plan.run("selection",
                 by_cut_ ? fmt::format("stochastic lightcuts, {} VPLs a tile", samples_)
                         : fmt::format("{} VPLs a tile, sampled by the light tree", samples_),
                 "unbiased; the same VPLs for a tile of 4 x 4");
        plan_memory(plan, "memory of the light tree", size);
    }

  private:
    std::uint32_t samples_;
    bool by_cut_;
};

}  // namespace

void register_stochastic_selection(Registry& registry) {
    add_selection<StochasticSelection>(
        registry, "stochastic_lightcuts",
        "Stochastic lightcuts (Yuksel 2019): one VPL sampled from each cluster of a cut for each tile, "
        "unbiased.",
        parameters, true);
    add_selection<StochasticSelection>(
        registry, "light_tree",
        "VPLs sampled by a light tree in proportion to their importance (Estevez and Kulla 2018): unbiased.",
        parameters, false);
}

}  // namespace mote::lights
