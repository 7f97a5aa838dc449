#include "compensation/spherical_lights.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/geometry/shadow_segment.h"
#include "core/math/kd_tree.h"
#include "core/scene/media_along.h"

namespace mote::compensation {

using namespace core;

namespace {

bool is_glossy(const ScatteringVertex& v) { return !v.diffuse_reflectance().has_value(); }

bool reflects_only(const ScatteringVertex& v) { return !v.bsdf->traits().transmissive; }
bool reflects_only(const SphericalLight& light) {
    return !light.detail || reflects_only(light.detail->vertex);
}

/// The sum over all samples; `arrives(w)`, the fraction of the light, is evaluated only for directions that
/// carry any.
template <typename Arrives>
Rgb sample_sphere(const ScatteringVertex& receiver, const SphericalLight& light, const SphereCone& cone,
                  const SampleCounts& n, Rng& rng, const Arrives& arrives) {
    Rgb sum(0.0f);
    const auto add = [&](const Vec3& w) {
        Rgb value = receiver.eval_cos(w, TransportMode::radiance) * light.intensity_cos(w);
        if (!is_black(value)) value *= arrives(w);
        if (is_black(value)) return;
        // Balance heuristic with n samples of each technique: Veach 1997, Eq. 9.8.
        float densities = 0.0f;
        if (n.receiver > 0)
            densities += float(n.receiver) * receiver.pdf_solid_angle(w, TransportMode::radiance);
        if (n.light > 0) densities += float(n.light) * light.pdf_solid_angle(w);
        sum += value * (cone.solid_angle_per_disc() / (float(n.cone) + cone.solid_angle() * densities));
    };
    for (int i = 0; i < n.cone; ++i) add(cone.sample(rng.next_vec2()));
    for (int i = 0; i < n.receiver; ++i) {
        const float u_lobe = rng.next_float();
        const auto s = receiver.sample(u_lobe, rng.next_vec2(), TransportMode::radiance);
        if (s && !s->delta && cone.contains(s->wi)) add(s->wi);
    }
    for (int i = 0; i < n.light; ++i) {
        const float u_lobe = rng.next_float();
        const auto s = light.detail->vertex.sample(u_lobe, rng.next_vec2(), TransportMode::power);
        if (s && !s->delta && cone.contains(-s->wi)) add(-s->wi);
    }
    return sum;
}

/// Light that one receiver gets from one sphere after the other.
class Gatherer {
  public:
    Gatherer(const RayQueries& scene, const SphericalGather& settings, const ScatteringVertex& receiver,
             Rng& rng, RayCounters& rays)
        : scene_(scene),
          settings_(settings),
          receiver_(receiver),
          glossy_(is_glossy(receiver)),
          reflects_(reflects_only(receiver)),
          normal_(glm::dot(receiver.hit.geometric_normal, receiver.wo) > 0.0f
                      ? receiver.hit.geometric_normal
                      : -receiver.hit.geometric_normal),
          rng_(rng),
          rays_(rays) {}

    Rgb light_of(const SphericalLight& light) const {
        if (turned_away(light)) return Rgb(0.0f);
        const SphereCone cone(receiver_.position, light.centre(), light.radius);
        const SampleCounts n(settings_.samples, glossy_, light.detail != nullptr);
        if (cone.inside() || settings_.visibility == SphereVisibility::per_light) {
            const Rgb sum =
                sample_sphere(receiver_, light, cone, n, rng_, [](const Vec3&) { return Rgb(1.0f); });
            return is_black(sum) ? sum : sum * from_centre(light, cone);
        }
        return sample_sphere(receiver_, light, cone, n, rng_,
                             [&](const Vec3& w) { return from_sphere(light, cone, w); });
    }

  private:
    /// True if the whole sphere lies below the receiver's horizon, or the receiver below all of the light's.
    bool turned_away(const SphericalLight& light) const {
        const Vec3 to = light.centre() - receiver_.position;
        if (reflects_ && glm::dot(normal_, to) < -light.radius) return true;
        return reflects_only(light) && glm::dot(light.vpl.normal, to) > light.radius;
    }
    /// Where light leaves y_j against w: off the surface, the end of a shadow ray.
    static Vec3 target(const SphericalLight& light, const Vec3& w) {
        return light.detail ? light.detail->vertex.ray_origin(-w) : light.vpl.position;
    }
    /// Visibility of a segment times the transmittance of its panes; there are no media.
    Rgb free(const Vec3& origin, const Vec3& direction, float distance) const {
        ++rays_.occlusion;
        const Ray segment{origin, direction, 0.0f, shadow_end(origin, distance)};
        if (!scene_.visible(segment)) return Rgb(0.0f);
        PathWeights passes;
        connect_through_panes(scene_, segment, passes);
        return passes.throughput;
    }
    Rgb from_centre(const SphericalLight& light, const SphereCone& cone) const {
        // Behind its own surface either end would start the ray inside the solid, past what hides it.
        if (reflects_ && !(glm::dot(normal_, cone.axis()) > 0.0f)) return Rgb(0.0f);
        if (reflects_only(light) && !(glm::dot(light.vpl.normal, cone.axis()) < 0.0f)) return Rgb(0.0f);
        const Vec3 origin = receiver_.ray_origin(cone.axis());
        const Vec3 to = target(light, cone.axis()) - origin;
        const float distance = glm::length(to);
        return distance > 0.0f ? free(origin, to / distance, distance) : Rgb(1.0f);
    }
    Rgb from_sphere(const SphericalLight& light, const SphereCone& cone, const Vec3& w) const {
        const Vec3 origin = receiver_.ray_origin(w);
        // Never 0/0: a direction along the plane carries no light and is not evaluated.
        const float to_plane =
            glm::dot(target(light, w) - origin, light.vpl.normal) / glm::dot(w, light.vpl.normal);
        if (!(to_plane > 0.0f)) return Rgb(0.0f);  // behind the light's surface, looking further away
        return free(origin, w, std::min(to_plane, cone.entry(w)));
    }

    const RayQueries& scene_;
    const SphericalGather& settings_;
    const ScatteringVertex& receiver_;
    bool glossy_, reflects_;
    Vec3 normal_;  ///< geometric, on the viewer's side
    Rng& rng_;
    RayCounters& rays_;
};

}  // namespace

Rgb SphericalLight::intensity_cos(const Vec3& w) const {
    if (detail) return vpl.intensity * detail->eval(-w) * detail->vertex.geometric_cosine(w);
    if (!(glm::dot(vpl.shading_normal, w) < 0.0f)) return Rgb(0.0f);
    return vpl.intensity * std::max(0.0f, -glm::dot(vpl.normal, w));
}

float SphericalLight::pdf_solid_angle(const Vec3& w) const {
    return detail ? detail->vertex.pdf_solid_angle(-w, TransportMode::power) : 0.0f;
}

std::vector<float> sphere_radii(const lights::VplSet& set, std::uint32_t neighbours, float scale) {
    std::vector<Vec3> points(set.lights.size());
    std::transform(set.lights.begin(), set.lights.end(), points.begin(),
                   [](const auto& vpl) { return vpl.position; });
    const KdTree tree(points);
    std::vector<float> radii(points.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 256), [&](const auto& range) {
        std::vector<KdTree::Neighbour> heap;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            tree.nearest(points[i], std::size_t(neighbours) + 1, infinity, heap);  // the light itself is one
            radii[i] = scale * std::sqrt(heap.front().distance_squared);
        }
    });
    return radii;
}

SampleCounts::SampleCounts(int samples, bool glossy_receiver, bool glossy_light) {
    // Cones come first: with one sample for two techniques, the one that covers everything is left.
    light = glossy_light ? samples / (glossy_receiver ? 3 : 2) : 0;
    receiver = glossy_receiver ? (samples - light) / 2 : 0;
    cone = samples - light - receiver;
}

Rgb unoccluded_light(const ScatteringVertex& receiver, const SphericalLight& light, int samples, Rng& rng) {
    const SphereCone cone(receiver.position, light.centre(), light.radius);
    const SampleCounts n(samples, is_glossy(receiver), light.detail != nullptr);
    return sample_sphere(receiver, light, cone, n, rng, [](const Vec3&) { return Rgb(1.0f); });
}

Rgb gather_spheres(const RayQueries& scene, const lights::VplSet& set, const std::vector<float>& radii,
                   const SphericalGather& settings, const ScatteringVertex& receiver,
                   std::int32_t max_vpl_depth, Rng& rng, RayCounters& rays) {
    const Gatherer gatherer(scene, settings, receiver, rng, rays);
    Rgb sum(0.0f);
    for (std::size_t i = 0; i < set.lights.size(); ++i)
        if (std::int32_t(set.lights[i].depth) <= max_vpl_depth)
            sum += gatherer.light_of(SphericalLight(set, i, radii[i]));
    return sum;
}

}  // namespace mote::compensation
