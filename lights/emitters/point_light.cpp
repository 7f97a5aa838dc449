// The point light: equal intensity in all directions from one point.
#include "core/math/warp.h"
#include "core/scene/medium.h"
#include "lights/emitters/emitters.h"
#include "lights/emitters/light_values.h"
#include "lights/emitters/point_connection.h"

namespace mote::lights {
namespace {

using namespace core;

class PointLight final : public Emitter {
  public:
    PointLight(const Vec3& position, const Rgb& intensity, std::shared_ptr<Medium> around = nullptr)
        : position_(position), intensity_(intensity), around_(std::move(around)) {
        medium = around_.get();
    }

    EmitterTraits traits() const override { return {.kind = EmitterKind::point, .delta_position = true}; }

    std::optional<DirectSample> sample_direct(const Vec3& p, const Vec2& /*u*/) const override {
        return connect_to_point(p, position_, [&](const Vec3&) { return intensity_; });
    }
    float pdf_direct(const Vec3&, const Vec3&, const SurfaceHit*) const override { return 0.0f; }

    std::optional<EmissionSample> sample_emission(const Vec2& /*u_position*/,
                                                  const Vec2& u_direction) const override {
        if (is_black(intensity_)) return std::nullopt;
        EmissionSample sample{};
        sample.origin = position_, sample.direction = square_to_sphere(u_direction);
        sample.pdf_area = 1.0f, sample.pdf_solid_angle = inv_four_pi;
        sample.weight = power();
        return sample;
    }
    EmissionDensity pdf_emission(const Vec3&, const Vec3&, const Vec3&) const override {
        return {1.0f, inv_four_pi};
    }
    Rgb power() const override { return 4.0f * pi * intensity_; }
    std::optional<LightBounds> bounds() const override {
        return LightBounds{.box = {position_, position_}, .intensity = double(average(intensity_))};
    }

  private:
    Vec3 position_;
    Rgb intensity_;
    std::shared_ptr<Medium> around_;
};

struct PointLightSettings {
    Rgb intensity{1.0f};
    Vec3d position{0.0};
    Transform to_world;
    std::shared_ptr<Medium> medium;
};

std::shared_ptr<Emitter> create_point(const PointLightSettings& s, const Properties& p) {
    if (p.has("position") && p.has("to_world"))
        throw InputError("a point light takes 'position' or 'to_world', not both", p.where_of("to_world"));
    warn_of_black(p, "intensity", max_component(s.intensity));
    const Vec3d position = p.has("to_world") ? s.to_world.point(Vec3d(0.0)) : s.position;
    return std::make_shared<PointLight>(Vec3(position), s.intensity, s.medium);
}

}  // namespace

std::shared_ptr<Emitter> make_point_light(const Vec3d& position, const Rgb& intensity) {
    if (!is_finite(Vec3(position))) throw InputError("the position of a point light is not finite");
    return std::make_shared<PointLight>(Vec3(position), checked_brightness(intensity, "intensity"));
}

void register_point(Registry& registry) {
    add_type<PointLightSettings>(
        registry, Category::emitter, "point", "A light at one point, equally bright in all directions.",
        {row("intensity", &PointLightSettings::intensity, brightness("W/sr"), "Radiant intensity."),
         point_row("position", &PointLightSettings::position, "m", "Its position."),
         row("to_world", &PointLightSettings::to_world, "Instead of position: moves the origin."),
         medium_row<PointLightSettings>()},
        R"(<emitter type="point">
    <point name="position" x="0" y="2" z="0"/>
    <rgb name="intensity" value="10"/>
</emitter>)",
        create_point);
}

}  // namespace mote::lights
