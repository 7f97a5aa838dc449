// The point light: equal intensity in all directions from one point.
#include "core/math/warp.h"
#include "core/objects/registry.h"
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

std::shared_ptr<Object> create(const Properties& properties) {
    if (properties.has("position") && properties.has("to_world"))
        throw InputError("a point light takes 'position' or 'to_world', not both",
                         properties.where_of("to_world"));
    const Vec3d origin = properties.get_transform().point(Vec3d(0.0));
    const Vec3d position = properties.get_vec3("position", origin);
    return std::make_shared<PointLight>(Vec3(position), read_brightness(properties, "intensity"),
                                        read_medium(properties));
}

}  // namespace

std::shared_ptr<Emitter> make_point_light(const Vec3d& position, const Rgb& intensity) {
    return std::make_shared<PointLight>(Vec3(position), checked_brightness(intensity, "intensity"));
}

void register_point(Registry& registry) {
    registry.add(
        {Category::emitter,
         "point",
         "A light at one point, equally bright in all directions.",
         {{"intensity", "rgb", "1", "radiant intensity [W/sr]"},
          {"position", "point", "0, 0, 0", "where it stands [m]"},
          {"to_world", "transform", "identity", "instead of position: moves the origin"},
          {"medium", "medium", "",
           "the medium around the light; when absent, that of the shapes around it, or the outermost one"}},
         R"(<emitter type="point">
    <point name="position" x="0" y="2" z="0"/>
    <rgb name="intensity" value="10"/>
</emitter>)"},
        create);
}

}  // namespace mote::lights
