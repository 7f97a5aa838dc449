// The spot light: a cone around +z, full intensity inside beam_width, from there falling linearly in the
// angle to zero at cutoff_angle, with an optional texture projected through the cone. Mitsuba 3's definition.
#include <algorithm>

#include "core/math/warp.h"
#include "core/scene/medium.h"
#include "lights/emitters/emitters.h"
#include "lights/emitters/light_cone.h"
#include "lights/emitters/light_values.h"
#include "lights/emitters/point_connection.h"

namespace mote::lights {
namespace {

using namespace core;

constexpr double degrees = 3.14159265358979323846 / 180.0;

class SpotLight final : public Emitter, public ConeLight {
  public:
    SpotLight(const SpotSettings& settings, const glm::mat3& rotation, std::shared_ptr<Medium> around)
        : position_(settings.to_world.point(Vec3d(0.0))),
          world_from_local_(rotation),
          intensity_(settings.intensity),
          cutoff_(float(settings.cutoff_angle)),
          beam_(float(settings.beam_width)),
          one_minus_cos_cutoff_(float(2.0 * std::pow(std::sin(0.5 * settings.cutoff_angle), 2))),
          texture_scale_(0.5f / float(std::tan(settings.cutoff_angle))),
          texture_(settings.texture),
          around_(std::move(around)) {
        medium = around_.get();
        power_ = estimate_power(settings);
    }

    EmitterTraits traits() const override {
        return {.kind = EmitterKind::spot, .delta_position = true, .textured = texture_ != nullptr};
    }

    std::optional<DirectSample> sample_direct(const Vec3& p, const Vec2& /*u*/) const override {
        return connect_to_point(p, position_, [&](const Vec3& away) {
            return intensity(glm::transpose(world_from_local_) * away);
        });
    }
    float pdf_direct(const Vec3&, const Vec3&, const SurfaceHit*) const override { return 0.0f; }

    std::optional<EmissionSample> sample_emission(const Vec2& /*u_position*/,
                                                  const Vec2& u_direction) const override {
        const Vec3 local = square_to_cone(u_direction, one_minus_cos_cutoff_);
        EmissionSample sample{};
        sample.pdf_area = 1.0f, sample.pdf_solid_angle = cone_pdf(one_minus_cos_cutoff_);
        sample.weight = intensity(local) / sample.pdf_solid_angle;
        if (is_black(sample.weight)) return std::nullopt;
        sample.origin = position_, sample.direction = glm::normalize(world_from_local_ * local);
        return sample;
    }
    EmissionDensity pdf_emission(const Vec3& /*origin*/, const Vec3& /*normal*/,
                                 const Vec3& direction) const override {
        return {1.0f, angle(glm::transpose(world_from_local_) * direction) < cutoff_
                          ? cone_pdf(one_minus_cos_cutoff_)
                          : 0.0f};
    }
    Rgb power() const override { return power_; }
    std::optional<LightBounds> bounds() const override {
        const float wider = std::fmax(0.0f, cutoff_ - 0.5f * pi);  // what is beyond a right angle of the axis
        return LightBounds{.box = {position_, position_},
                           .normals = {world_from_local_ * Vec3(0, 0, 1), wider},
                           .reach = cutoff_ - wider,
                           .intensity = double(average(power_) * cone_pdf(one_minus_cos_cutoff_))};
    }
    LightCone cone() const override {
        return {position_, world_from_local_ * Vec3(0, 0, 1), double(cutoff_),
                texture_ ? 0.0 : double(beam_)};
    }

  private:
    /// Between the unit vector d of the light's own frame and its axis. acos(d.z) loses half the digits of a
    /// narrow cone's angle.
    static float angle(const Vec3& d) { return std::atan2(std::hypot(d.x, d.y), d.z); }
    /// Radiant intensity [W/sr] towards the unit vector d of the light's own frame.
    Rgb intensity(const Vec3& d) const {
        const float a = angle(d);
        if (!(a < cutoff_)) return Rgb(0.0f);
        const float fall_off = a <= beam_ ? 1.0f : (cutoff_ - a) / (cutoff_ - beam_);
        return fall_off * intensity_ * (texture_ ? texture_->eval(texture_coordinates(d)) : Rgb(1.0f));
    }
    /// The unit square circumscribes the cone.
    Vec2 texture_coordinates(const Vec3& d) const {
        return {0.5f + texture_scale_ * d.x / d.z, 0.5f + texture_scale_ * d.y / d.z};
    }

    Rgb estimate_power(const SpotSettings& s) const {
        // 2 pi int f(theta) sin(theta) dtheta with a linear fall-off from beam b to cutoff c is
        // 2 pi (1 - (sin c - sin b)/(c - b)); the quotient is cos of the middle times sinc of half the width.
        const double half = 0.5 * (s.cutoff_angle - s.beam_width);
        const double sinc = half > 0.0 ? std::sin(half) / half : 1.0;
        const double solid_angle = 2.0 * double(pi) * (1.0 - std::cos(s.cutoff_angle - half) * sinc);
        const Rgb plain = s.intensity * float(solid_angle);
        if (!texture_) return plain;
        // Means over a regular grid of the cone; a pattern finer than that still leaves the plain mean.
        constexpr int n = 64;
        glm::dvec3 sum(0.0);
        for (int i = 0; i < n * n; ++i) {
            const Vec2 u((float(i % n) + 0.5f) / n, (float(i / n) + 0.5f) / n);
            sum += glm::dvec3(intensity(square_to_cone(u, one_minus_cos_cutoff_)));
        }
        const Rgb mean = Rgb(sum / double(n * n)) / cone_pdf(one_minus_cos_cutoff_);
        return is_black(mean) ? plain * texture_->mean() : mean;
    }

    Vec3 position_;
    glm::mat3 world_from_local_;
    Rgb intensity_;
    float cutoff_, beam_;  ///< radians
    float one_minus_cos_cutoff_;
    float texture_scale_;
    TexturePtr texture_;
    std::shared_ptr<Medium> around_;
    Rgb power_;
};

std::shared_ptr<Emitter> checked_spot(const SpotSettings& s, const SourceLocation& where,
                                      std::shared_ptr<Medium> around) {
    checked_brightness(s.intensity, "intensity", where);
    const double limit = (s.texture ? 89.9 : 180.0) * degrees;
    if (!(s.cutoff_angle >= 1e-6 && s.cutoff_angle <= limit * (1.0 + 1e-12)))
        throw InputError(
            "a spot's 'cutoff_angle' must be above 0 and at most 180 degrees, below 90 with a texture",
            where);
    if (!(s.beam_width >= 0.0 && s.beam_width <= s.cutoff_angle * (1.0 + 1e-12)))
        throw InputError("a spot's 'beam_width' must lie between 0 and 'cutoff_angle'", where);
    if (s.texture) {
        checked_brightness(Rgb(s.texture->minimum()), "texture", where);
        checked_brightness(Rgb(s.texture->maximum()), "texture", where);
    }
    return std::make_shared<SpotLight>(s, checked_rotation(s.to_world, where), std::move(around));
}

/// As a scene file gives it: angles in degrees.
struct SpotFileSettings {
    Rgb intensity{1.0f};
    double cutoff_angle = 20.0;
    std::optional<double> beam_width;
    TexturePtr texture;
    Transform to_world;
    std::shared_ptr<Medium> medium;
};

std::shared_ptr<Emitter> create_spot(const SpotFileSettings& s, const Properties& p) {
    SpotSettings spot;
    spot.to_world = s.to_world;
    spot.intensity = s.intensity;
    spot.cutoff_angle = s.cutoff_angle * degrees;
    spot.beam_width = s.beam_width.value_or(0.75 * spot.cutoff_angle / degrees) * degrees;
    spot.texture = s.texture;
    warn_of_black(p, "intensity", max_component(s.intensity));
    if (s.texture) warn_of_black(p, "texture", s.texture->maximum());
    return checked_spot(spot, p.where, s.medium);
}

}  // namespace

std::shared_ptr<Emitter> make_spot_light(const SpotSettings& settings) {
    return checked_spot(settings, {}, nullptr);
}

void register_spot(Registry& registry) {
    add_type<SpotFileSettings>(
        registry, Category::emitter, "spot",
        "A cone of light from one point along +z, with a linear fall-off at its rim.",
        {row("intensity", &SpotFileSettings::intensity, brightness("W/sr"),
             "Radiant intensity inside the beam."),
         row("cutoff_angle", &SpotFileSettings::cutoff_angle, any("degrees"),
             "Half angle of the cone, black beyond."),
         row("beam_width", &SpotFileSettings::beam_width, any("degrees"), "Half angle of full intensity.")
             .when_absent("0.75 cutoff_angle"),
         row("texture", &SpotFileSettings::texture,
             "Projected through the cone; its square touches the cone; multiplies."),
         row("to_world", &SpotFileSettings::to_world, "Places and turns the light; no stretching."),
         medium_row<SpotFileSettings>()},
        R"(<emitter type="spot">
    <transform name="to_world"><lookat origin="0, 3, 0" target="0, 0, 0" up="0, 0, 1"/></transform>
    <rgb name="intensity" value="20"/>
    <float name="cutoff_angle" value="30"/>
</emitter>)",
        create_spot);
}

}  // namespace mote::lights
