// The directional light: parallel rays from infinity, such as sunlight.
#include "core/objects/registry.h"
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
    /// What falls on the scene's bounding sphere.
    Rgb power() const override { return irradiance_ * scene_.disk_area(); }

  private:
    Vec3 direction_;  ///< in which the light travels
    Rgb irradiance_;
    SceneSphere scene_;
};

std::shared_ptr<Object> create(const Properties& properties) {
    if (properties.has("direction") && properties.has("to_world"))
        throw InputError("a directional light takes 'direction' or 'to_world', not both",
                         properties.where_of("to_world"));
    const bool named = properties.has("direction");
    const Vec3d forward = properties.get_transform().vector(Vec3d(0, 0, 1));
    const Vec3 direction = checked_direction(properties.get_vec3("direction", forward),
                                             properties.where_of(named ? "direction" : "to_world"));
    return std::make_shared<DirectionalLight>(direction, read_brightness(properties, "irradiance"));
}

}  // namespace

std::shared_ptr<Emitter> make_directional_light(const Vec3d& direction, const Rgb& irradiance) {
    return std::make_shared<DirectionalLight>(checked_direction(direction),
                                              checked_brightness(irradiance, "irradiance"));
}

void register_directional(Registry& registry) {
    registry.add({Category::emitter,
                  "directional",
                  "Parallel light from infinity.",
                  {{"irradiance", "rgb", "1", "what a surface facing the light receives [W/m^2]"},
                   {"direction", "vector", "0, 0, 1", "in which the light travels"},
                   {"to_world", "transform", "identity", "instead of direction: turns +z"}},
                  R"(<emitter type="directional">
    <vector name="direction" x="1" y="-2" z="0.5"/>
    <rgb name="irradiance" value="3, 2.9, 2.7"/>
</emitter>)"},
                 create);
}

}  // namespace mote::lights
