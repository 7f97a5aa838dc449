// The weights of two techniques that make the same paths: virtual point lights joined to a receiver x, and
// points y that a bundle of parallel rays finds from x, joined to a light or to a virtual point light
// (Tokuyoshi & Ogaki 2012, Sec. 4).
//
// A path z .. y, x is made
//   by the VPL at y           with  N s_1 p(z) p(z -> y)                 p(z -> y) per area at y,
//   by the bundle             with  M p(z | y) p_r(x -> y) C(y -> x) / |x-y|^2,
// where z is a point of a light or the VPL before y. If z is a light, the first has the density of its
// particles, and the second that of next-event estimation at y. If z is a VPL, both have what led to it,
// which cancels, and the second a fraction s_2 of them. The balance heuristic of a path needs their ratio
// alone; what of it depends on y and not on x is one number of the VPL, its `rival` a_j [m^2 sr]:
//   w_1 = 1 / (1 + a_j p_r C(y -> x) / |x-y|^2).
// Eqs. 4 and 5 are this for a point light, with the common factor C(y -> x) C(y -> z) / (|x-y|^2 |y-z|^2)
// left out. Both techniques find the ratio by the same functions, so that the weights of a path add up to 1
// whatever rounding or roulette does to its density.
//
// The second of the two singularities, |z-y| -> 0, is the paper's reason to bound paths of two bounces (Eqs.
// 7 and 8). Here they are weighted as well: near y the VPL before it has w_2 -> 0, near x the VPL at y has
// w_1
// -> 0. Nothing is left out.
//
// Where both edges are short, in a corner of a corner, neither has small values. So a bundle's path continues
// from y with chance c, by a cosine-weighted direction with the density e(y -> z) per area, and what it finds
// is lit in turn, again and again. A path v_1 .. v_j, x has then j + 1 techniques: its last k vertices are
// found from x, and the last found is joined to what is before it. The density of the k-th is
//   k = 0:  s_1                     p(v_1 -> v_2) .. p(v_{j-1} -> v_j)   times what led to v_1,
//   k > 0:  s_2 M P(x -> v_j) c e(v_j -> v_{j-1}) .. c e(v_{j-k+2} -> v_{j-k+1})  p(v_1 -> v_2) .. p(.. ->
//   v_{j-k}),
// with P = p_r C / |x-y|^2 (k = j connects a light instead of joining v_0). Seen from the light path all but
// the first have the factor P(x -> v_j), and the rest does not depend on x. So a VPL has one rival still,
//   a_j = (M s_2 / s_1 + c e(v_j -> v_{j-1}) a_{j-1}) / p(v_{j-1} -> v_j),                                (1)
// and a point y_k that was found has one number, the density of all techniques that find fewer points over
// its own, but for the last step p(z -> y_k) of the light path and for s_2:
//   b_1 = s_1 / (M P(x -> y_1)),   b_k = (s_2 + p(y_k -> y_{k-1}) b_{k-1}) / (c e(y_{k-1} -> y_k)). (2)
#pragma once

#include <span>

#include "core/scene/lit_scene.h"
#include "lights/virtual_lights/virtual_point_light.h"
#include "lights/virtual_lights/vpl_receivers.h"

namespace mote::gathering {

/// A direction serves both ways: lines that are uniform over all directions (Tokuyoshi & Ogaki 2012,
/// Sec. 3.3). The weights use it for directions of any density: they add up to 1 all the same.
inline constexpr float uniform_line_pdf = core::inv_two_pi;

/// Numbers of samples that a receiver gets from each technique.
struct TechniqueSamples {
    float directions = 0.0f;         ///< M
    float paths = 0.0f;              ///< N, light paths
    float light_probability = 1.0f;  ///< s_1, the chance of a VPL to meet a receiver
    float joined_probability =
        0.0f;                ///< s_2, the chance of a VPL to be joined to a point that a bundle found
    float continued = 0.0f;  ///< c, the probability that a bundle's path continues from a point
};

/// Larger than any ratio of densities that matters, and small enough to be multiplied.
inline constexpr float certain = 1e30f;

/// p(z | y) by next-event estimation over p(z -> y) of the light's particles [m^2], for a light that `start`
/// describes (its origin, or any point towards a light at infinity). `normal` is the geometric one at y. 0
/// where next-event estimation does not find the light, `certain` where particles do not find y.
float connection_over_emission(const core::LitScene& scene, const core::LightReceiver& y,
                               const core::Vec3& normal, const lights::LightStart& start);

/// Density with which the light path continues from the VPL z to y, per area at y [1/m^2]: that of its BSDF,
/// |cos| / pi for a plain one. `g` is G*, with `cos_y` of the shading normal at y; `direction` is z -> y.
inline float next_vertex_pdf(const lights::VplDetail* z, const core::Vec3& direction, float g, float cos_y,
                             float distance_squared) {
    if (!z) return g * core::inv_pi;
    return z->vertex.pdf_solid_angle(direction, core::TransportMode::power) * cos_y / distance_squared;
}

/// Density e(y -> z) of a bundle's path that continues, per area at z [1/m^2], from G* with the shading
/// cosine at y and the geometric one at z.
inline float continued_pdf(float g) { return g * core::inv_pi; }
/// If true, a bundle's path may continue at y. On a transmissive surface the side to continue on would be
/// that of x.
inline bool may_continue(const core::ScatteringVertex& y) { return !y.bsdf->traits().transmissive; }

/// b_k of Eq. (2) at a point y that a bundle's path found. On a glossy surface a part of it has the density
/// of light that comes from z and continues to the point before y.
struct FewerFound {
    float plain = 0.0f, by_pdf = 0.0f;

    float from(const core::ScatteringVertex& y, const core::Vec3& towards_z) const {
        if (by_pdf == 0.0f) return plain;
        core::ScatteringVertex lit = y;
        lit.wo = towards_z;
        return plain + by_pdf * lit.pdf_solid_angle(y.wo, core::TransportMode::power);
    }
};

/// b_1; `found` is P(x -> y) [1/m^2].
FewerFound fewer_than_one(const TechniqueSamples& samples, float found);
/// b_k at `next`, which a path found from y, where it is `fewer`. Eq. (2).
FewerFound fewer_than_next(const TechniqueSamples& samples, const core::ScatteringVertex& y,
                           const FewerFound& fewer, const core::ScatteringVertex& next);

/// The weight of a light that is connected to y: `fewer` is b_k, `ratio` p(z | y) / (p(z) p(z -> y)).
inline float connection_weight(const TechniqueSamples& samples, float fewer, float ratio) {
    return ratio / (ratio + samples.paths * fewer + 1e-37f);  // Eq. 6 with beta = 1
}

/// a_j of every light, Eq. (1): 0 where bundles cannot make its paths. Needs VplSet::starts.
std::vector<float> rivals_of(const core::LitScene& scene, const lights::VplSet& vpls,
                             const TechniqueSamples& samples);

/// Density that a glossy receiver's own ray, sampled by its BSDF, adds to that of a line [1/sr], where there
/// are M lines: p_f / M. Neither bundles nor virtual point lights can follow a narrow lobe.
inline float own_ray_pdf(const core::ScatteringVertex& x, const core::Vec3& w, float directions) {
    return x.pdf_solid_angle(w, core::TransportMode::radiance) / directions;
}

/// The policy w_1 G* of gathering at receivers (lights/virtual_lights/geometry_weights.h).
struct AgainstBundles {
    std::span<const float> rivals;

    struct ForLight {
        float rival;  ///< a_j p_r
        float operator()(float g, float d2, float, float cos_y) const {
            // Tokuyoshi & Ogaki 2012, Eq. 6 with beta = 1. Nothing at all where no shadow ray should be shot.
            return rival < certain ? g / (1.0f + rival * cos_y / d2) : 0.0f;
        }
    };
    ForLight for_pair(const lights::ReceiverLanes&, const lights::VplSet&, std::size_t j) const {
        return {rivals[j] < certain ? rivals[j] * uniform_line_pdf : certain};
    }
};

/// AgainstBundles where glossy receivers have rays of their own.
struct AgainstBundlesAndOwnRays {
    std::span<const float> rivals;
    float directions;  ///< M

    struct ForLight {
        float rival;  ///< a_j
        float directions;
        const lights::ReceiverLanes& x;
        core::Vec3 y;

        float operator()(float g, float d2, float cos_x, float cos_y, int lane) const {
            float pdf = uniform_line_pdf;
            if (const core::ScatteringVertex* vertex = x.directional[lane])
                pdf += own_ray_pdf(*vertex, (y - vertex->position) / std::sqrt(d2), directions);
            return AgainstBundles::ForLight{rival < certain ? rival * pdf : certain}(g, d2, cos_x, cos_y);
        }
    };
    ForLight for_pair(const lights::ReceiverLanes& x, const lights::VplSet& vpls, std::size_t j) const {
        const lights::VirtualPointLight& y = vpls.lights[j];
        const bool plain = y.detail == lights::VirtualPointLight::no_detail;
        return {rivals[j], directions, x, plain ? y.position : vpls.details[y.detail].vertex.position};
    }
};

/// The policy of joining VPLs z to sixteen points y that bundles' paths found: its weight times G*.
struct AgainstLights {
    const FewerFound* fewer;        ///< b_k, by lane
    std::span<const float> rivals;  ///< of the VPLs
    TechniqueSamples samples;

    struct ForLight {
        const AgainstLights& all;
        const lights::ReceiverLanes& y;
        const lights::VplDetail* z;
        core::Vec3 position;  ///< of z
        float rival;          ///< c s_1 a_z / M

        float operator()(float g, float d2, float cos_y, float, int lane) const {
            const core::ScatteringVertex* glossy = y.directional[lane];
            core::Vec3 direction(0.0f);  // from z to y
            if (z || glossy) {
                const core::Vec3 at = glossy ? glossy->position : core::Vec3(y.x[lane], y.y[lane], y.z[lane]);
                direction = (at - position) / std::sqrt(d2);
            }
            const FewerFound& b = all.fewer[lane];
            const float fewer_found = next_vertex_pdf(z, direction, g, cos_y, d2) *
                                      (glossy ? b.from(*glossy, -direction) : b.plain);
            const float more = glossy && !may_continue(*glossy) ? 0.0f : rival * continued_pdf(g);
            const float joined = all.samples.joined_probability;
            return g * joined / (joined + fewer_found + more + 1e-37f);
        }
    };
    ForLight for_pair(const lights::ReceiverLanes& y, const lights::VplSet& vpls, std::size_t index) const {
        const std::uint32_t detail = vpls.lights[index].detail;
        const bool plain = detail == lights::VirtualPointLight::no_detail;
        const float more = samples.continued * samples.light_probability / samples.directions;
        return {*this, y, plain ? nullptr : &vpls.details[detail],
                plain ? vpls.lights[index].position : vpls.details[detail].vertex.position,
                more * rivals[index]};
    }
};

}  // namespace mote::gathering
