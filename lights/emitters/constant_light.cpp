// The constant environment: the same radiance from every direction.
#include "lights/emitters/emitters.h"
#include "lights/emitters/light_values.h"
#include "lights/emitters/scene_sphere.h"

namespace mote::lights {
namespace {

using namespace core;

class ConstantLight final : public Emitter {
  public:
    explicit ConstantLight(const Rgb& radiance) : radiance_(radiance) {}

    EmitterTraits traits() const override { return {.kind = EmitterKind::environment, .infinite = true}; }
    void set_scene_bounds(const Vec3& center, float radius) override { scene_ = {center, radius}; }

    std::optional<DirectSample> sample_direct(const Vec3& /*p*/, const Vec2& u) const override {
        if (is_black(radiance_)) return std::nullopt;
        DirectSample sample{};
        sample.wi = square_to_sphere(u), sample.distance = infinity;
        sample.weight = 4.0f * pi * radiance_, sample.pdf_solid_angle = inv_four_pi;
        return sample;
    }
    float pdf_direct(const Vec3&, const Vec3&, const SurfaceHit*) const override { return inv_four_pi; }
    Rgb environment(const Vec3& /*wi*/) const override { return radiance_; }

    std::optional<EmissionSample> sample_emission(const Vec2& u_position,
                                                  const Vec2& u_direction) const override {
        if (is_black(radiance_)) return std::nullopt;
        EmissionSample sample{};
        sample.direction = square_to_sphere(u_direction);
        sample.origin = scene_.origin_on_disk(sample.direction, u_position);
        sample.pdf_area = scene_.pdf_area(), sample.pdf_solid_angle = inv_four_pi;
        sample.weight = power();
        return sample;
    }
    EmissionDensity pdf_emission(const Vec3& origin, const Vec3& /*normal*/,
                                 const Vec3& direction) const override {
        return {scene_.pdf_area(origin, direction), inv_four_pi};
    }
    /// Power on the scene's bounding sphere.
    Rgb power() const override { return 4.0f * pi * scene_.disk_area() * radiance_; }

  private:
    Rgb radiance_;
    SceneSphere scene_;
};

}  // namespace

std::shared_ptr<Emitter> make_constant_light(const Rgb& radiance) {
    return std::make_shared<ConstantLight>(checked_brightness(radiance, "radiance"));
}

void register_constant(Registry& registry) {
    struct Settings {
        Rgb radiance{1.0f};
    };
    add_type<Settings>(registry, Category::emitter, "constant",
                       "An environment of the same radiance in every direction.",
                       {row("radiance", &Settings::radiance, brightness("W/(m^2 sr)"), "Radiance.")},
                       R"(<emitter type="constant">
    <rgb name="radiance" value="0.5"/>
</emitter>)",
                       [](const Settings& s, const Properties& p) {
                           warn_of_black(p, "radiance", max_component(s.radiance));
                           return std::make_shared<ConstantLight>(s.radiance);
                       });
}

}  // namespace mote::lights
