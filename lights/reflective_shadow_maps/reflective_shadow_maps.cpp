#include "lights/reflective_shadow_maps/reflective_shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lights/virtual_lights/light_source.h"

namespace mote::lights {

using namespace core;

ReflectiveShadowMaps::ReflectiveShadowMaps(const LitScene& scene, int size, std::uint32_t other_paths)
    : scene_(scene), texels_(std::uint32_t(size) * std::uint32_t(size)), other_paths_(0) {
    if (size <= 0) throw std::invalid_argument("a reflective shadow map has texels");
    if (const float radius = scene.bounds().radius(); radius > 0.0f)
        distance_ = std::ldexp(1.0f, std::ilogb(radius));
    for (const auto& emitter : scene.emitters())
        if (const auto view = shadow_map_view_of(scene, *emitter, size))
            maps_.push_back({emitter.get(), *view});
        else if (!is_black(emitter->power()))
            other_paths_ = other_paths;
}

std::optional<LightPathStart> ReflectiveShadowMaps::start(std::uint32_t path, Sampler& sampler) const {
    if (path >= texels()) return of_other_light(sampler);
    const Map& map = maps_[path / texels_];
    const int texel = int(path % texels_), size = map.view.size;
    const Vec2 position = (Vec2(float(texel % size), float(texel / size)) + sampler.next_2d()) / float(size);
    const Ray ray = map.view.ray_at(position);
    // The intensity is what arrives times the squared distance; of parallel light it is the irradiance.
    const auto light = map.emitter->sample_direct(ray.at(distance_), Vec2(0.5f));
    if (!light) return std::nullopt;
    const float per_solid_angle = map.emitter->traits().infinite ? 1.0f : sqr(distance_);
    EmissionSample emission{};
    emission.origin = ray.origin, emission.direction = ray.direction;
    emission.pdf_area = emission.pdf_solid_angle = 1.0f;
    emission.weight = light->weight * per_solid_angle * map.view.measure(position);
    if (is_black(emission.weight)) return std::nullopt;
    return LightPathStart{map.emitter, emission, emission.weight / float(texels_)};
}

std::optional<LightPathStart> ReflectiveShadowMaps::of_other_light(Sampler& sampler) const {
    float u_light = sampler.next_1d();
    const LightChoice choice = scene_.choose_emitter_by_power(u_light, &u_light);
    const Vec2 u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    const auto is_chosen = [&](const Map& map) { return map.emitter == choice.emitter; };
    if (!choice.emitter || std::any_of(maps_.begin(), maps_.end(), is_chosen)) return std::nullopt;
    const auto emission = choice.emitter->sample_emission(u_position, u_direction);
    if (!emission) return std::nullopt;
    return LightPathStart{choice.emitter, *emission,
                          emission->weight / (choice.probability * float(other_paths_))};
}

namespace {

class ReflectiveLightSource final : public LightSource {
  public:
    ReflectiveLightSource(const LitScene& scene, int size, const LightPathSettings& settings)
        : LightSource(scene, settings), size_(size), maps_(scene, size, settings.paths) {
        settings_.paths = maps_.paths();
    }
    VplSet trace(std::uint64_t seed, std::uint32_t pass, SamplerKind sampler,
                 CancelToken cancelled) const override {
        return trace_light_paths(scene_, settings_, seed, pass, sampler, cancelled, &maps_);
    }
    void plan(Plan& plan) const override {
        plan.run("reflective shadow maps",
                 std::to_string(maps_.maps()) + " of " + std::to_string(size_) + "^2 texels",
                 maps_.maps() > 0 ? "each texel begins a light path, its flux is intensity times solid angle"
                                  : "no light is a point, a cone or parallel");
        LightSource::plan(plan);
    }

  private:
    int size_;
    ReflectiveShadowMaps maps_;
};

}  // namespace

std::unique_ptr<LightSource> reflective_light_source(const LitScene& scene, int size,
                                                     const LightPathSettings& settings) {
    return std::make_unique<ReflectiveLightSource>(scene, size, settings);
}

}  // namespace mote::lights
