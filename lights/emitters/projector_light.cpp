// The projector: a picture projected through a pinhole, the perspective camera turned round. Mitsuba 3's
// definition: on the plane at distance 1 a surface that faces the projector receives pi times the picture, so
// that the radiant intensity is
//   I(w) = pi scale E(u, v) / cos^3,
// with the angle between w and the axis. A diffuse white wall at distance 1 then shows the picture's values.
#include <algorithm>

#include "core/cameras/sensors.h"
#include "core/materials/pictured_texture.h"
#include "core/materials/textures.h"
#include "core/math/distribution.h"
#include "core/scene/medium.h"
#include "lights/emitters/emitters.h"
#include "lights/emitters/light_cone.h"
#include "lights/emitters/light_values.h"
#include "lights/emitters/point_connection.h"

namespace mote::lights {
namespace {

using namespace core;

/// Directions are sampled by the picture with this chance, else evenly over it: no place that shines is
/// missed, however the texture is made.
constexpr float by_picture = 0.9f;
constexpr int finest_table = 512;  // cells along a side

/// One by one where the texture shows no picture.
glm::ivec2 size_of(const Texture& texture) {
    const auto* picture = dynamic_cast<const PicturedTexture*>(&texture);
    return picture ? picture->resolution() : glm::ivec2(1);
}

class ProjectorLight final : public Emitter, public ConeLight {
  public:
    ProjectorLight(const ProjectorSettings& s, const glm::mat3& rotation, std::shared_ptr<Medium> around)
        : position_(s.to_world.point(Vec3d(0.0))),
          world_from_local_(rotation),
          scale_(pi * s.scale),
          half_(float(s.tan_half_fov_x), float(s.tan_half_fov_x / aspect_of(*s.irradiance))),
          picture_(s.irradiance),
          around_(std::move(around)) {
        medium = around_.get();
        make_table();
    }

    EmitterTraits traits() const override {
        return {.kind = EmitterKind::spot, .delta_position = true, .textured = !picture_->constant()};
    }

    std::optional<DirectSample> sample_direct(const Vec3& p, const Vec2& /*u*/) const override {
        return connect_to_point(p, position_, [&](const Vec3& away) {
            return intensity(glm::transpose(world_from_local_) * away);
        });
    }
    float pdf_direct(const Vec3&, const Vec3&, const SurfaceHit*) const override { return 0.0f; }

    std::optional<EmissionSample> sample_emission(const Vec2& /*u_position*/,
                                                  const Vec2& u_direction) const override {
        const Vec2 uv = sample_picture(u_direction);
        const Vec3 through((1.0f - 2.0f * uv.x) * half_.x, (1.0f - 2.0f * uv.y) * half_.y, 1.0f);
        const Vec3 local = glm::normalize(through);
        EmissionSample sample{};
        sample.pdf_area = 1.0f, sample.pdf_solid_angle = pdf_solid_angle(uv, local.z);
        sample.weight = intensity(local) / sample.pdf_solid_angle;
        if (is_black(sample.weight) || !is_finite(sample.weight)) return std::nullopt;
        sample.origin = position_, sample.direction = glm::normalize(world_from_local_ * local);
        return sample;
    }
    EmissionDensity pdf_emission(const Vec3& /*origin*/, const Vec3& /*normal*/,
                                 const Vec3& direction) const override {
        const Vec3 local = glm::transpose(world_from_local_) * direction;
        const auto uv = picture_place(local);
        return {1.0f, uv ? pdf_solid_angle(*uv, local.z) : 0.0f};
    }
    Rgb power() const override { return power_; }
    std::optional<LightBounds> bounds() const override {
        const LightCone around = cone();
        return LightBounds{.box = {position_, position_},
                           .normals = DirectionCone::of(around.axis),
                           .reach = float(around.angle),
                           .intensity = double(average(power_)) / solid_angle()};
    }
    /// Around the picture's corners.
    LightCone cone() const override {
        return {position_, world_from_local_ * Vec3(0, 0, 1), double(std::atan(glm::length(half_)))};
    }

  private:
    static double aspect_of(const Texture& picture) {
        const glm::ivec2 size = size_of(picture);
        return double(size.x) / double(size.y);
    }
    /// Area of the picture on the plane at distance 1.
    float area() const { return 4.0f * half_.x * half_.y; }
    /// That the picture fills, seen from the light: four right pyramids.
    double solid_angle() const {
        const double x = double(half_.x), y = double(half_.y);
        return 4.0 * std::atan(x * y / std::sqrt(1.0 + x * x + y * y));
    }
    /// Where the picture is seen in the unit direction d of the light's own frame: its upper left corner,
    /// (0, 0), lies at +x and +y, as a camera's does. Nothing beside the picture.
    std::optional<Vec2> picture_place(const Vec3& d) const {
        if (!(d.z > 0.0f)) return std::nullopt;
        const Vec2 uv(0.5f - 0.5f * d.x / (d.z * half_.x), 0.5f - 0.5f * d.y / (d.z * half_.y));
        if (!(uv.x >= 0.0f && uv.x <= 1.0f && uv.y >= 0.0f && uv.y <= 1.0f)) return std::nullopt;
        return uv;
    }
    /// Radiant intensity [W/sr].
    Rgb intensity(const Vec3& d) const {
        const auto uv = picture_place(d);
        return uv ? picture_->eval(*uv) * (scale_ / (d.z * d.z * d.z)) : Rgb(0.0f);
    }
    Vec2 sample_picture(const Vec2& u) const {
        if (table_.empty()) return u;
        if (u.x >= by_picture) return {(u.x - by_picture) / (1.0f - by_picture), u.y};
        return table_.sample({u.x / by_picture, u.y}).uv;
    }
    /// A solid angle dw around the cosine c covers the fraction dw / (c^3 area) of the picture.
    float pdf_solid_angle(const Vec2& uv, float cosine) const {
        const float per_picture = table_.empty() ? 1.0f : 1.0f - by_picture + by_picture * table_.pdf(uv);
        return per_picture / (cosine * cosine * cosine * area());
    }

    /// Cells hold the mean of the middles of their four quarters: the integral itself where the picture has a
    /// cell for every texel, be it filtered bilinearly (bilinear over each quarter) or not at all. No quarter
    /// lies at a rim, so that cells beside a bright one get no more than what filtering puts there.
    void make_table() {
        const glm::ivec2 size = size_of(*picture_);
        const bool unknown = size.x * size.y == 1 && !picture_->constant();
        const int nx = unknown ? 64 : std::clamp(size.x, 1, finest_table),
                  ny = unknown ? 64 : std::clamp(size.y, 1, finest_table);
        std::vector<float> cells;
        glm::dvec3 sum(0.0);
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x) {
                glm::dvec3 cell(0.0);
                for (int k = 0; k < 4; ++k)
                    cell += glm::dvec3(
                        picture_->eval(Vec2((float(x) + 0.25f + 0.5f * float(k % 2)) / float(nx),
                                            (float(y) + 0.25f + 0.5f * float(k / 2)) / float(ny))));
                cells.push_back(luminance(Rgb(0.25 * cell)));
                sum += 0.25 * cell;
            }
        if (!picture_->constant()) table_ = Distribution2D(cells, std::size_t(nx), std::size_t(ny));
        Rgb mean(sum / double(nx * ny));
        if (is_black(mean)) mean = picture_->mean();
        power_ = mean * (scale_ * area());
    }

    Vec3 position_;
    glm::mat3 world_from_local_;
    float scale_;
    Vec2 half_;  ///< half width and height of the picture at distance 1
    TexturePtr picture_;
    std::shared_ptr<Medium> around_;
    Distribution2D table_;  ///< empty: even
    Rgb power_{0.0f};
};

std::shared_ptr<Emitter> checked_projector(ProjectorSettings s, const SourceLocation& where,
                                           std::shared_ptr<Medium> around) {
    if (!s.irradiance) s.irradiance = make_constant_texture(Rgb(1.0f));
    checked_brightness(Rgb(s.irradiance->minimum()), "irradiance", where);
    checked_brightness(Rgb(s.irradiance->maximum()), "irradiance", where);
    checked_brightness(Rgb(s.scale), "scale", where);
    if (!(s.tan_half_fov_x > 0.0) || !(s.tan_half_fov_x < 1e6))
        throw InputError("a projector's field of view must lie between 0 and 180 degrees", where);
    return std::make_shared<ProjectorLight>(s, checked_rotation(s.to_world, where), std::move(around));
}

struct ProjectorFileSettings {
    TexturePtr irradiance = make_constant_texture(Rgb(1.0f));
    float scale = 1.0f;
    Transform to_world;
    ViewSettings view;
    std::shared_ptr<Medium> medium;
};

std::shared_ptr<Emitter> create_projector(const ProjectorFileSettings& s, const Properties& p) {
    ProjectorSettings projector;
    projector.to_world = rigid_to_world(s.to_world, p);
    projector.irradiance = s.irradiance, projector.scale = s.scale;
    warn_of_black(p, "irradiance", s.irradiance->maximum());
    const glm::ivec2 size = size_of(*s.irradiance);
    projector.tan_half_fov_x = tan_half_fov_x(s.view, double(size.x) / double(size.y), p);
    warn_of_black(p, "scale", s.scale);
    return checked_projector(projector, p.where, s.medium);
}

}  // namespace

std::shared_ptr<Emitter> make_projector_light(const ProjectorSettings& settings) {
    return checked_projector(settings, {}, nullptr);
}

void register_projector(Registry& registry) {
    add_type<ProjectorFileSettings>(
        registry, Category::emitter, "projector",
        "Throws a picture along +z, as a perspective camera with these parameters would see it; +X is to the "
        "picture's left. Multiplied by pi: a white diffuse wall at distance 1 shows its values.",
        {row("irradiance", &ProjectorFileSettings::irradiance, brightness("W/(m^2 sr)"),
             "The picture: irradiance over pi at distance 1, on a surface that faces the projector."),
         row("scale", &ProjectorFileSettings::scale, brightness(), "Multiplies the picture."),
         row("to_world", &ProjectorFileSettings::to_world, "Places and turns the light; no scaling."),
         medium_row<ProjectorFileSettings>(), within(&ProjectorFileSettings::view, view_rows())},
        R"(<emitter type="projector">
    <transform name="to_world"><lookat origin="0, 2, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
    <float name="fov" value="30"/>
    <texture name="irradiance" type="checkerboard"/>
</emitter>)",
        create_projector);
}

}  // namespace mote::lights
