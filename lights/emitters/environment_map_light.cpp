// The environment map: light from all around, given by a latitude-longitude picture
// (environment_picture.h).
#include "core/formats/pictures/image_file.h"
#include "lights/emitters/emitters.h"
#include "lights/emitters/environment_picture.h"
#include "lights/emitters/light_values.h"
#include "lights/emitters/scene_sphere.h"

namespace mote::lights {
namespace {

using namespace core;

class EnvironmentMap final : public Emitter {
  public:
    EnvironmentMap(EnvironmentPicture map, const glm::mat3& rotation, float scale)
        : map_(std::move(map)), world_from_local_(rotation), scale_(scale) {}

    EmitterTraits traits() const override {
        return {.kind = EmitterKind::environment, .infinite = true, .textured = true};
    }
    void set_scene_bounds(const Vec3& center, float radius) override { scene_ = {center, radius}; }

    std::optional<DirectSample> sample_direct(const Vec3& /*p*/, const Vec2& u) const override {
        if (dark()) return std::nullopt;
        const auto s = map_.sample(u);
        const Rgb weight = scale_ * map_.eval(s.direction) / s.pdf_solid_angle;
        if (is_black(weight) || !is_finite(weight)) return std::nullopt;
        const Vec3 wi = glm::normalize(world_from_local_ * s.direction);
        return DirectSample{wi, infinity, weight, s.pdf_solid_angle, false, Vec3(0.0f)};
    }
    float pdf_direct(const Vec3&, const Vec3& wi, const SurfaceHit*) const override {
        return dark() ? 0.0f : map_.pdf_solid_angle(to_local(wi));
    }
    Rgb environment(const Vec3& wi) const override { return scale_ * map_.eval(to_local(wi)); }

    std::optional<EmissionSample> sample_emission(const Vec2& u_position,
                                                  const Vec2& u_direction) const override {
        const auto from = sample_direct(scene_.center, u_direction);
        if (!from) return std::nullopt;
        EmissionSample sample{};
        sample.direction = -from->wi;
        sample.origin = scene_.origin_on_disk(sample.direction, u_position);
        sample.pdf_area = scene_.pdf_area(), sample.pdf_solid_angle = from->pdf_solid_angle;
        sample.weight = from->weight * scene_.disk_area();
        return sample;
    }
    EmissionDensity pdf_emission(const Vec3& origin, const Vec3& /*normal*/,
                                 const Vec3& direction) const override {
        return {scene_.pdf_area(origin, direction), pdf_direct(origin, -direction, nullptr)};
    }
    /// Power on the scene's bounding sphere; exact.
    Rgb power() const override { return scale_ * scene_.disk_area() * map_.integral(); }

  private:
    bool dark() const { return !(scale_ > 0.0f) || map_.black(); }
    Vec3 to_local(const Vec3& w) const { return glm::transpose(world_from_local_) * w; }

    EnvironmentPicture map_;
    glm::mat3 world_from_local_;
    float scale_;
    SceneSphere scene_;
};

struct EnvironmentMapSettings {
    FileName file;
    float scale = 1.0f;
    bool mis_compensation = false;
    Transform to_world;
};

std::shared_ptr<Emitter> create_environment_map(const EnvironmentMapSettings& s, const Properties& p) {
    Bitmap picture = read_bitmap(s.file.path, false);
    check_pixels(picture, s.file.written, p.where_of("filename"));
    if (s.mis_compensation) p.warn("'mis_compensation' has no effect: every lit direction keeps its chance");
    const glm::mat3 rotation = checked_rotation(s.to_world, p.where_of("to_world"));
    EnvironmentPicture map(std::move(picture));
    if (map.black() || s.scale == 0.0f) p.warn("this environment map is black: it emits nothing");
    return std::make_shared<EnvironmentMap>(std::move(map), rotation, s.scale);
}

}  // namespace

std::shared_ptr<Emitter> make_environment_map(Bitmap picture, const Transform& to_world, float scale) {
    check_pixels(picture, "<pixels>");
    checked_brightness(Rgb(scale), "scale");
    return std::make_shared<EnvironmentMap>(EnvironmentPicture(std::move(picture)),
                                            checked_rotation(to_world), scale);
}

void register_envmap(Registry& registry) {
    add_type<EnvironmentMapSettings>(
        registry, Category::emitter, "envmap",
        "Light from all around, from a latitude-longitude picture: y is up, u = atan2(x, -z) / 2 pi, "
        "v = acos(y) / pi. Columns wrap around, the first and the last row lie at the poles.",
        {row("filename", &EnvironmentMapSettings::file, any("W/(m^2 sr)"),
             "The picture (EXR, HDR, PNG, ...).")
             .required(),
         row("scale", &EnvironmentMapSettings::scale, brightness(), "Multiplies the picture."),
         row("mis_compensation", &EnvironmentMapSettings::mis_compensation,
             "Known from Mitsuba 3, without effect."),
         row("to_world", &EnvironmentMapSettings::to_world, "Turns the picture; no stretching.")},
        R"(<emitter type="envmap">
    <string name="filename" value="sky.exr"/>
    <float name="scale" value="2"/>
</emitter>)",
        create_environment_map);
}

}  // namespace mote::lights
