#include "core/materials/lobe_bounds.h"

namespace mote::core {
namespace {

constexpr float slack = 1.0f + 1e-3f;

float angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// At least D(m) of all m at an angle of `least` or more from the normal. The wider roughness alone gives
/// slopes that are too small, and so a D that is too large.
float density_bound(const Microfacet& facets, float least) {
    const float widest = std::fmax(facets.alpha_u(), facets.alpha_v());
    const float scale = inv_pi / (facets.alpha_u() * facets.alpha_v());
    const float cos2 = sqr(std::cos(std::fmin(least, 0.5f * pi))), sin2 = 1.0f - cos2;
    if (facets.kind() == MicrofacetKind::ggx) {
        // cos^2 + sin^2 / alpha^2 grows with the angle where alpha is below 1, and falls to 1 / alpha^2
        // above.
        const float denominator = widest <= 1.0f ? cos2 + sin2 / sqr(widest) : 1.0f / sqr(widest);
        return scale / sqr(denominator);
    }
    // (1 + t)^2 exp(-t / alpha^2) with t = tan^2 has its maximum at 1 + t = 2 alpha^2.
    const float peak = std::fmax(1.0f, 2.0f * sqr(widest));
    const float one_plus_t = cos2 > 0.0f ? std::fmax(1.0f / cos2, peak) : infinity;
    const float exponent = (one_plus_t - 1.0f) / sqr(widest);
    return exponent < 90.0f ? scale * std::exp(-exponent) * sqr(one_plus_t) : 0.0f;
}

}  // namespace

LobeBound::LobeBound(const Microfacet& facets, const Vec3& wo, const DirectionCone& wi) {
    const float from_wo = angle_between(wo, wi.axis), angle = wi.angle + 1e-5f;
    min_cosine_ = std::cos(0.5f * std::fmin(from_wo + angle, pi));
    // wi + wo is at most 2 sin(angle / 2) from axis + wo, whose length is 2 cos(from_wo / 2).
    const float moved = 2.0f * std::sin(0.5f * std::fmin(angle, pi));
    const Vec3 middle = wo + wi.axis;
    const float length = glm::length(middle);
    float least = 0.0f;  // angle of half vectors from the normal
    if (moved < 0.999f * length) {
        const float from_normal = std::atan2(std::sqrt(sqr(middle.x) + sqr(middle.y)), middle.z);
        least = std::fmax(0.0f, from_normal - std::asin(moved / length) - 1e-5f);
    }
    // A(w) grows with the cosine and with both roughnesses, where these are at most 1.
    const Microfacet smoothest(facets.kind(), std::fmin(1.0f, std::fmin(facets.alpha_u(), facets.alpha_v())));
    const float lowest = std::fmin(0.5f * pi, angle_between(wi.axis, {0, 0, 1}) + angle);
    const float area = smoothest.projected_area({std::sin(lowest), 0.0f, std::cos(lowest)});
    facets_ = slack * density_bound(facets, least) / (4.0f * facets.projected_area(wo) * area);
}

float dielectric_bound(float min_cosine, float eta) {
    if (eta == 1.0f) return 0.0f;
    const float c = min_cosine, cos2_t = ((eta - 1.0f) * (eta + 1.0f) + c * c) / sqr(eta);
    if (!(cos2_t > 0.0f)) return 1.0f;
    const float t = std::sqrt(cos2_t);
    const float perpendicular = (c - eta * t) / (c + eta * t), parallel = (eta * c - t) / (eta * c + t);
    const float normal = (eta - 1.0f) / (eta + 1.0f);
    return std::fmin(1.0f, slack * 0.5f * (sqr(perpendicular) + std::fmax(sqr(parallel), sqr(normal))));
}

}  // namespace mote::core
