// VPLs sampled uniformly as a selection: the baseline that the others are measured against.
//
// The set is divided into n even strata, and one VPL sampled from each for a tile, with weight N / n: every
// VPL is expected n / N times, so the sum is unbiased. Whether a VPL is near, visible or bright is not
// considered.
#include <fmt/format.h>

#include "lights/selection/register_selection.h"
#include "lights/selection/sampling_selector.h"

namespace mote::lights {

using namespace core;

namespace {

struct UniformSettings {
    std::uint32_t samples = 64;
};

class TileUniform final : public SamplingSelector {
  public:
    TileUniform(const VplSet& vpls, float bound, std::uint32_t samples)
        : SamplingSelector(vpls, bound), lights_(vpls.lights.size()), samples_(samples) {}

  protected:
    std::span<const WeightedVpl> sample(const ReceiverLanes&, Rng& rng) override {
        const double stride = double(lights_) / double(samples_.size());
        for (std::size_t i = 0; i < samples_.size() && lights_ > 0; ++i) {
            const auto index = std::size_t((double(i) + double(rng.next_float())) * stride);
            samples_[i] = {std::min(index, lights_ - 1), float(stride)};
        }
        return std::span(samples_).first(lights_ > 0 ? samples_.size() : 0);
    }

  private:
    std::size_t lights_;  ///< N
    std::vector<WeightedVpl> samples_;
};

class UniformSelection final : public Selection {
  public:
    explicit UniformSelection(const UniformSettings& settings) : samples_(settings.samples) {}
    bool is_unbiased() const override { return true; }
    VplSelector prepare(const SelectionPass& pass) const override {
        return [&vpls = pass.vpls, bound = pass.bound, samples = samples_] {
            return std::make_unique<TileUniform>(vpls, bound, samples);
        };
    }
    std::size_t memory_bytes(std::size_t) const override { return 0; }
    void plan(Plan& plan, const SelectionSize&) const override {
        plan.run("selection", fmt::format("{} VPLs a tile, sampled uniformly", samples_),
                 "unbiased; the same VPLs for a tile of 4 x 4");
    }

  private:
    std::uint32_t samples_;
};

}  // namespace

void register_uniform_selection(Registry& registry) {
    add_selection<UniformSelection>(
        registry, "uniform",
        "VPLs sampled uniformly: unbiased, the baseline that other selections are measured against.",
        ParameterList<UniformSettings>{
            row("samples", &UniformSettings::samples, between(1, 1 << 20),
                "VPLs sampled for each tile of 4 x 4 pixels: time is in proportion to it, the variance "
                "inversely.")});
}

}  // namespace mote::lights
