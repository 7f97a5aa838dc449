// A plugin with a selection of virtual point lights: each receiver tile samples them by their intensity.
//
//   mote render scene.xml --plugin my_selector.so --integrator mote_vpl -D integrator.selection=by_intensity
//
// Of N VPLs n are sampled with replacement, VPL j with p_j = I_j / sum I, and weighted by 1 / (n p_j):
// unbiased, and the lights' distances and normals are not considered. Every VPL keeps a share of uniform
// probability, since one that looks dark from its own side may be bright at a receiver (a directional VPL's
// intensity is not in I_j).
#include <mote/core/math/distribution.h>
#include <mote/core/objects/plugin.h>
#include <mote/lights/selection/register_selection.h>
#include <mote/lights/selection/sampling_selector.h>

using namespace mote;

namespace {

struct Settings {
    std::uint32_t samples = 64;
    float uniform = 0.1f;
};

/// p_j of a pass.
core::Distribution1D probabilities(const lights::VplSet& vpls, float uniform) {
    std::vector<float> weights;
    double total = 0.0;
    for (const lights::VirtualPointLight& light : vpls.lights)
        total += double(core::average(light.intensity));
    const double even = 1.0 / double(vpls.lights.size());
    for (const lights::VirtualPointLight& light : vpls.lights) {
        const double bright = total > 0.0 ? double(core::average(light.intensity)) / total : even;
        weights.push_back(float(double(uniform) * even + (1.0 - double(uniform)) * bright));
    }
    return core::Distribution1D(weights);
}

class TileByIntensity final : public lights::SamplingSelector {
  public:
    TileByIntensity(const lights::VplSet& vpls, float bound, std::shared_ptr<const core::Distribution1D> p,
                    std::uint32_t samples)
        : SamplingSelector(vpls, bound), probabilities_(std::move(p)), chosen_(samples) {}

  protected:
    std::span<const lights::WeightedVpl> sample(const lights::ReceiverLanes&, core::Rng& rng) override {
        if (probabilities_->empty()) return {};
        const float n = float(chosen_.size());
        for (std::size_t i = 0; i < chosen_.size(); ++i) {
            // Stratified: the i-th of n even parts of the unit interval.
            const auto j = probabilities_->sample_discrete((float(i) + rng.next_float()) / n);
            chosen_[i] = {j.index, 1.0f / (n * j.probability)};
        }
        return chosen_;
    }

  private:
    std::shared_ptr<const core::Distribution1D> probabilities_;
    std::vector<lights::WeightedVpl> chosen_;
};

class ByIntensity final : public lights::Selection {
  public:
    explicit ByIntensity(const Settings& settings) : settings_(settings) {}
    lights::VplSelector prepare(const lights::SelectionPass& pass) const override {
        check_memory(pass);
        const auto p =
            std::make_shared<const core::Distribution1D>(probabilities(pass.vpls, settings_.uniform));
        return [&vpls = pass.vpls, bound = pass.bound, p, samples = settings_.samples] {
            return std::make_unique<TileByIntensity>(vpls, bound, p, samples);
        };
    }
    std::size_t memory_bytes(std::size_t vpls) const override {
        return vpls * (sizeof(double) + sizeof(float));
    }
    void plan(core::Plan& plan, const lights::SelectionSize& size) const override {
        plan.run("selection", std::to_string(settings_.samples) + " VPLs a tile, sampled by intensity",
                 "unbiased");
        plan_memory(plan, "selection: memory", size);
    }
    bool is_unbiased() const override { return true; }

  private:
    Settings settings_;
};

void register_types(core::Registry& registry) {
    lights::add_selection<ByIntensity>(
        registry, "by_intensity", "VPLs sampled by their intensity: unbiased.",
        core::ParameterList<Settings>{core::row("samples", &Settings::samples, core::between(1, 1 << 20),
                                                "VPLs sampled for each tile."),
                                      core::row("uniform", &Settings::uniform, core::between(1e-6, 1),
                                                "Share of the probability that all VPLs have alike.")});
}

}  // namespace

MOTE_PLUGIN(register_types)
