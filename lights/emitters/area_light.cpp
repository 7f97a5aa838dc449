// The area light: the front side of a shape emits the same radiance in all directions. Front is where the
// geometric normal points to, in evaluation, density and particles alike: mixing it with the shading normal
// would make the two halves disagree at silhouettes.
#include "core/geometry/bsdf_point.h"
#include "core/geometry/shape.h"
#include "core/math/warp.h"
#include "lights/emitters/emitters.h"
#include "lights/emitters/light_values.h"
#include "lights/emitters/parallelogram_light.h"

namespace mote::lights {
namespace {

using namespace core;

class AreaLight final : public Emitter, public ParallelogramLight {
  public:
    /// `scale` multiplies the texture.
    AreaLight(const Rgb& radiance, TexturePtr texture, SourceLocation location = {}, float scale = 1.0f)
        : radiance_(radiance), scale_(scale), texture_(std::move(texture)) {
        where = std::move(location);
    }

    EmitterTraits traits() const override {
        return {.kind = EmitterKind::area, .textured = texture_ && !texture_->constant()};
    }

    void set_shape(const Shape* shape) override {
        if (shape_ && shape_ != shape) throw InputError("one area light cannot belong to two shapes", where);
        shape_ = shape;
    }
    void set_scene_bounds(const Vec3&, float) override {
        if (!shape_) throw InputError("an area light must be nested in a shape", where);
    }

    std::optional<DirectSample> sample_direct(const Vec3& p, const Vec2& u) const override {
        float pdf = 0.0f;
        const auto point = shape_ ? shape_->sample_visible(p, u, pdf) : std::nullopt;
        if (!point || !(pdf > 0.0f) || !std::isfinite(pdf)) return std::nullopt;
        const Vec3 d = point->position - p;
        const float distance = glm::length(d);
        if (!(distance > 0.0f)) return std::nullopt;
        const Vec3 wi = d / distance;
        if (!(glm::dot(point->normal, wi) < 0.0f)) return std::nullopt;
        const Rgb weight = emitted(texture_place(*point)) / pdf;
        if (is_black(weight) || !is_finite(weight)) return std::nullopt;
        return DirectSample{wi, distance, weight, pdf, false, point->normal};
    }
    float pdf_direct(const Vec3& p, const Vec3& wi, const SurfaceHit* hit) const override {
        if (!hit || !shape_ || !(glm::dot(hit->geometric_normal, wi) < 0.0f)) return 0.0f;
        return shape_->pdf_visible(p, wi, *hit);
    }
    Rgb radiance(const SurfaceHit& hit, const Vec3& wo) const override {
        return glm::dot(hit.geometric_normal, wo) > 0.0f ? emitted(texture_place(hit)) : Rgb(0.0f);
    }

    std::optional<EmissionSample> sample_emission(const Vec2& u_position,
                                                  const Vec2& u_direction) const override {
        if (!shape_) return std::nullopt;
        const ShapeSample point = shape_->sample_area(u_position);
        if (!(point.pdf_area > 0.0f)) return std::nullopt;
        const Rgb radiance = emitted(texture_place(point));
        if (is_black(radiance)) return std::nullopt;
        const Vec3 local = square_to_cosine_hemisphere(u_direction);
        EmissionSample sample{};
        sample.direction = Frame(point.normal).to_world(local);
        sample.origin = offset_origin(point.position, point.normal, point.error, sample.direction);
        sample.normal = point.normal;
        sample.pdf_area = point.pdf_area, sample.pdf_solid_angle = cosine_hemisphere_pdf(local);
        sample.weight = radiance * (pi / point.pdf_area);  // the cosine cancels
        sample.shape = shape_;
        return sample;
    }
    EmissionDensity pdf_emission(const Vec3& /*origin*/, const Vec3& normal,
                                 const Vec3& direction) const override {
        if (!shape_ || !(shape_->area() > 0.0f)) return {};
        return {1.0f / shape_->area(), std::fmax(0.0f, glm::dot(normal, direction)) * inv_pi};
    }
    std::optional<LitParallelogram> parallelogram() const override {
        const auto* mesh = texture_ ? nullptr : dynamic_cast<const TriangleMesh*>(shape_);
        const auto shape = mesh ? mesh->parallelogram() : std::nullopt;
        return shape ? std::optional(LitParallelogram{*shape, radiance_}) : std::nullopt;
    }
    std::optional<LightBounds> bounds() const override {
        if (!shape_) return std::nullopt;
        const DirectionCone normals = shape_->normals();
        // A flat one sends L A along its normal, others less: a ball L A / 4.
        const double flat = normals.angle < 0.5f * pi ? 1.0 : 0.25;
        return LightBounds{.box = shape_->bounds(),
                           .normals = normals,
                           .back = normals.angle <= 1e-4f ? shape_->support(-normals.axis) : infinity,
                           .intensity = flat * double(average(power())) * double(inv_pi)};
    }
    Rgb power() const override {
        if (!shape_) return Rgb(0.0f);
        const SurfaceAttributes* attributes = shape_->attributes();
        const Rgb mean = !texture_    ? radiance_
                         : attributes ? scale_ * texture_->mean_over(*attributes)
                                      : scale_ * texture_->mean();
        return mean * (pi * shape_->area());
    }

  private:
    Rgb emitted(const TextureCoordinates& uv) const {
        return texture_ ? scale_ * texture_->eval(uv) : radiance_;
    }

    Rgb radiance_;
    float scale_;
    TexturePtr texture_;  ///< takes the place of radiance_ where there is one
    const Shape* shape_ = nullptr;
};

TexturePtr checked_texture(TexturePtr texture, const SourceLocation& where, float scale = 1.0f) {
    checked_brightness(scale * Rgb(texture->minimum()), "radiance", where);
    checked_brightness(scale * Rgb(texture->maximum()), "radiance", where);
    return texture;
}

struct AreaLightSettings {
    TexturePtr radiance = make_constant_texture(Rgb(1.0f));
    float scale = 1.0f;
};

std::shared_ptr<Emitter> create_area(const AreaLightSettings& s, const Properties& p) {
    if (p.child<Texture>("radiance")) {
        warn_of_black(p, "radiance", s.scale * s.radiance->maximum());
        return std::make_shared<AreaLight>(
            Rgb(0.0f), checked_texture(s.radiance, p.where_of("radiance"), s.scale), p.where, s.scale);
    }
    const Rgb radiance = s.radiance->mean();
    warn_of_black(p, "radiance", max_component(radiance));
    return std::make_shared<AreaLight>(
        checked_brightness(s.scale * radiance, "radiance", p.where_of("scale")), nullptr, p.where);
}

}  // namespace

std::shared_ptr<Emitter> make_area_light(const Rgb& radiance) {
    return std::make_shared<AreaLight>(checked_brightness(radiance, "radiance"), nullptr);
}
std::shared_ptr<Emitter> make_area_light(TexturePtr radiance) {
    return std::make_shared<AreaLight>(Rgb(0.0f), checked_texture(std::move(radiance), {}));
}

void register_area(Registry& registry) {
    add_type<AreaLightSettings>(
        registry, Category::emitter, "area",
        "Makes the shape around it emit from its front side, where the normal points to.",
        {row("radiance", &AreaLightSettings::radiance, brightness("W/(m^2 sr)"),
             "Emitted radiance, a colour or a texture."),
         row("scale", &AreaLightSettings::scale, brightness(),
             "Multiplies the radiance (not known to Mitsuba).")},
        R"(<emitter type="area">
    <rgb name="radiance" value="18, 14, 7"/>
</emitter>)",
        create_area);
}

}  // namespace mote::lights
