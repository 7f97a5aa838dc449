// The directional light: parallel rays from infinity, such as sunlight.
#include "lights/emitters/emitters.h"
#include "lights/emitters/light_values.h"
#include "lights/emitters/scene_sphere.h"

namespace mote::lights {
namespace {

using namespace core;

class DirectionalLight final : public Emitter {
  public:
    DirectionalLight(const Vec3& direction, const Rgb& irradiance)
        : direction_(direction), irradiance_(irradiance) {}

    EmitterTraits traits() const override {
        return {.kind = EmitterKind::directional, .delta_direction = true, .infinite = true};
    }
    void set_scene_bounds(const Vec3& center, float radius) override { scene_ = {center, radius}; }

    std::optional<DirectSample> sample_direct(const Vec3& /*p*/, const Vec2& /*u*/) const override {
        if (is_black(irradiance_)) return std::nullopt;
        DirectSample sample{};
        sample.wi = -direction_, sample.distance = infinity;
        sample.weight = irradiance_, sample.delta = true;
        return sample;
    }
    float pdf_direct(const Vec3&, const Vec3&, const SurfaceHit*) const override { return 0.0f; }

    std::optional<EmissionSample> sample_emission(const Vec2& u_position,
                                                  const Vec2& /*u_direction*/) const override {
        if (is_black(irradiance_)) return std::nullopt;
        EmissionSample sample{};
        sample.origin = scene_.origin_on_disk(direction_, u_position), sample.direction = direction_;
        sample.pdf_area = scene_.pdf_area(), sample.pdf_solid_angle = 1.0f;
        sample.weight = power();
        return sample;
    }
    EmissionDensity pdf_emission(const Vec3& origin, const Vec3& /*normal*/,
                                 const Vec3& /*direction*/) const override {
        return {scene_.pdf_area(origin, direction_), 1.0f};
    }
    /// Power on the scene's bounding sphere.
    Rgb power() const override { return irradiance_ * scene_.disk_area(); }

  private:
    Vec3 direction_;  ///< in which the light travels
    Rgb irradiance_;
    SceneSphere scene_;
};

struct DirectionalLightSettings {
    Rgb irradiance{1.0f};
    Vec3d direction{0.0, 0.0, 1.0};
    Transform to_world;
};

std::shared_ptr<Emitter> create_directional(const DirectionalLightSettings& s, const Properties& p) {
    const bool turned = p.has("to_world");
    if (turned && p.has("direction"))
        throw InputError("a directional light takes 'direction' or 'to_world', not both",
                         p.where_of("to_world"));
    const Vec3d direction = turned ? s.to_world.vector(Vec3d(0, 0, 1)) : s.direction;
    warn_of_black(p, "irradiance", max_component(s.irradiance));
    return std::make_shared<DirectionalLight>(
        checked_direction(direction, p.where_of(turned ? "to_world" : "direction")), s.irradiance);
}

}  // namespace

std::shared_ptr<Emitter> make_directional_light(const Vec3d& direction, const Rgb& irradiance) {
    return std::make_shared<DirectionalLight>(checked_direction(direction),
                                              checked_brightness(irradiance, "irradiance"));
}

void register_directional(Registry& registry) {
    add_type<DirectionalLightSettings>(
        registry, Category::emitter, "directional", "Parallel light from infinity.",
        {row("irradiance", &DirectionalLightSettings::irradiance, brightness("W/m^2"),
             "Irradiance of a surface that faces it."),
         row("direction", &DirectionalLightSettings::direction, "In which the light travels."),
         row("to_world", &DirectionalLightSettings::to_world, "Instead of direction: turns +z.")},
        R"(<emitter type="directional">
    <vector name="direction" x="1" y="-2" z="0.5"/>
    <rgb name="irradiance" value="3, 2.9, 2.7"/>
</emitter>)",
        create_directional);
}

}  // namespace mote::lights
