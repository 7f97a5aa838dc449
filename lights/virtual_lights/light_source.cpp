#include "lights/virtual_lights/light_source.h"

namespace mote::lights {

using namespace core;

namespace {

class TracedLightSource final : public LightSource {
  public:
    TracedLightSource(const LitScene& scene, const LightPathSettings& settings)
        : scene_(scene), settings_(settings) {}
    VplSet trace(std::uint64_t seed, std::uint32_t pass, SamplerKind sampler,
                 CancelToken cancelled) const override {
        return trace_light_paths(scene_, settings_, seed, pass, sampler, cancelled);
    }
    void plan(Plan& plan) const override {
        plan.run("light paths", std::to_string(settings_.paths) + " a pass", "a fresh set every pass");
    }

  private:
    const LitScene& scene_;
    LightPathSettings settings_;
};

}  // namespace

std::unique_ptr<LightSource> traced_light_source(const LitScene& scene, const LightPathSettings& settings) {
    return std::make_unique<TracedLightSource>(scene, settings);
}

}  // namespace mote::lights
