#include "core/render/mirrored_features.h"

#include "core/geometry/bsdf_point.h"
#include "core/scene/emitter.h"
#include "core/scene/scene.h"

namespace mote::core {

namespace {

constexpr float widest_density =
    1.0f;  ///< [1/sr], of the skirts of a narrow lobe: thrice that of a diffuse one

/// True where there is a narrow lobe about the mirrored direction, or about the middle of what the BSDF
/// samples.
bool has_narrow_lobe(const SurfaceHit& hit, const Vec3& wo) {
    const Bsdf& bsdf = *hit.shape->bsdf;
    const BsdfTraits traits = bsdf.traits();
    if (traits.null || traits.diffuse) return false;
    if (traits.delta) return true;
    const BsdfPoint point = bsdf_point(hit);
    const auto is_narrow = [&](const Vec3& wi) {
        return bsdf.pdf_solid_angle(point, wo, wi, TransportMode::radiance) * narrow_lobe > 1.0f;
    };
    const auto middle = bsdf.sample(point, wo, 0.5f, Vec2(0.5f), TransportMode::radiance);
    return is_narrow(Vec3(-wo.x, -wo.y, wo.z)) || (middle && is_narrow(middle->wi));
}

/// A direction of such a lobe; nothing where the BSDF samples one of a wide lobe beside it.
std::optional<BsdfSample> narrow_sample(const SurfaceHit& hit, const Vec3& wo, float u_lobe, const Vec2& u) {
    const auto s = hit.shape->bsdf->sample(bsdf_point(hit), wo, u_lobe, u, TransportMode::radiance);
    if (!s || (!s->delta && !(s->pdf_solid_angle > widest_density))) return std::nullopt;
    return s;
}

Ray onwards(const SurfaceHit& hit, const BsdfSample& sample) {
    const Vec3 direction = hit.shading.to_world(sample.wi);
    return {offset_origin(hit, direction), direction};
}

/// Follows narrow lobes from `ray` on, and adds what is seen at their end.
void follow(const Scene& scene, Ray ray, Rng& rng, MirroredHit& sum) {
    Rgb weight(1.0f);
    for (int bounce = 0;; ++bounce) {
        const auto hit = scene.first_hit(ray);
        if (!hit) {
            if (const Emitter* sky = scene.environment())
                sum.emission += weight * sky->environment(ray.direction);
            return;
        }
        if (hit->shape->emitter) sum.emission += weight * hit->shape->emitter->radiance(*hit, -ray.direction);
        const Vec3 wo = hit->shading.to_local(-ray.direction);
        std::optional<BsdfSample> s;
        if (bounce + 1 < mirror_bounces && has_narrow_lobe(*hit, wo)) {
            const float u_lobe = rng.next_float();
            s = narrow_sample(*hit, wo, u_lobe, rng.next_vec2());
        }
        if (!s) {
            sum.position += hit->position;
            sum.normal += glm::dot(hit->shading.n, ray.direction) > 0.0f ? -hit->shading.n : hit->shading.n;
            sum.albedo += weight * hit->shape->bsdf->albedo(bsdf_point(*hit), wo);
            return;
        }
        weight *= s->weight;
        ray = onwards(*hit, *s);
    }
}

const MirroredHit& mirrored(const FirstHit& first) {
    if (first.mirrored) return *first.mirrored;
    constexpr int side = 8;
    static_assert(side * side == mirror_samples);
    MirroredHit sum;
    const Vec3 wo = first.hit.shading.to_local(first.to_viewer());
    const int samples = has_narrow_lobe(first.hit, wo) ? mirror_samples : 0;
    for (int i = 0; i < samples; ++i) {
        const Vec2 cell(float(i % side), float(i / side));
        const Vec2 u = (cell + first.rng.next_vec2()) / float(side);
        // Lobes are strata as well, in an order that has nothing to do with that of the directions.
        const float u_lobe =
            (float((23 * i) % mirror_samples) + first.rng.next_float()) / float(mirror_samples);
        if (const auto s = narrow_sample(first.hit, wo, u_lobe, u))
            follow(first.scene, onwards(first.hit, *s), first.rng, sum);
    }
    const float n = float(mirror_samples);
    sum.position /= n, sum.normal /= n, sum.albedo /= n, sum.emission /= n;
    return first.mirrored.emplace(sum);
}

bool may_mirror(const Shape& shape) {
    if (shape.bsdf->traits().pane) return false;
    SurfaceHit hit;
    hit.shape = &shape;
    hit.shading = Frame(Vec3(0, 0, 1));
    return has_narrow_lobe(hit, Vec3(0, 0, 1));
}

HitFeature feature(std::string name, std::string description, std::function<Rgb(const MirroredHit&)> value) {
    return {{"Mirrored." + std::move(name), std::move(description), true, true},
            [value = std::move(value)](const FirstHit& f) { return value(mirrored(f)); }};
}

}  // namespace

std::vector<HitFeature> mirrored_features(const Scene& scene) {
    bool any = false;
    for (const auto& shape : scene.shapes()) any = any || may_mirror(*shape);
    if (!any) return {};
    return {
        feature("Emission", "of lamps and sky, in mirrors and glass",
                [](const MirroredHit& m) { return m.emission; }),
        feature("Albedo", "of what mirrors and glass show", [](const MirroredHit& m) { return m.albedo; }),
        feature("P", "position of what mirrors and glass show",
                [](const MirroredHit& m) { return m.position; }),
        feature("Ns", "shading normal of what mirrors and glass show",
                [](const MirroredHit& m) { return m.normal; })};
}

}  // namespace mote::core
