#include "core/materials/bent_normal.h"

#include "core/math/frame.h"

namespace mote::core {
namespace {

bool same_side(const Vec3& m, const Vec3& w) { return w.z * glm::dot(w, m) > 0.0f; }
Vec3 turned_over(const Vec3& m) { return {-m.x, -m.y, m.z}; }

/// The frame keeps the direction of dp/du.
Frame frame_around(const Vec3& m) { return Frame(m, Vec3(1.0f, 0.0f, 0.0f)); }

BsdfPoint seen_in(const Frame& frame, const BsdfPoint& p) {
    BsdfPoint q = p;
    q.dp_du = frame.to_local(p.dp_du), q.dp_dv = frame.to_local(p.dp_dv);
    q.geometric_normal = frame.to_local(p.geometric_normal);
    return q;
}

/// Estevez et al. 2019, Eqs. 1 and 2: the masking of GGX facets whose slopes are such as m.
float shadowing(const Vec3& m, const Vec3& light) {
    const float alpha2 = std::fmin(0.125f * tan2_theta(m), 1.0f);
    return 2.0f / (1.0f + std::sqrt(1.0f + alpha2 * tan2_theta(light)));
}

}  // namespace

BentNormal::BentNormal(BsdfPtr nested, const BentNormalSettings& settings, bool textured)
    : nested_(std::move(nested)), settings_(settings), traits_(nested_->traits()) {
    traits_.diffuse = false;
    traits_.textured = traits_.textured || textured;
    traits_.anisotropic = true;
}

Vec3 BentNormal::unit_normal(const BsdfPoint& p) const {
    const Vec3 m = normal(p);
    const float length = glm::length(m);
    return length > 0.0f && std::isfinite(length) ? m / length : Vec3(0.0f, 0.0f, 1.0f);
}

/// The bent normal as seen from `eye`.
Vec3 BentNormal::towards(const Vec3& m, const Vec3& eye) const {
    return settings_.flip_invalid_normals && !same_side(m, eye) ? turned_over(m) : m;
}

/// f |light.n| over the nested f |light.m|; zero where light or eye is below one of the two.
float BentNormal::visible_factor(const Vec3& m, const Vec3& eye, const Vec3& light) const {
    const float shading = std::fabs(light.z);
    if (!same_side(m, eye) || !same_side(m, light) || !(shading > 1e-12f)) return 0.0f;
    return std::fabs(glm::dot(light, m)) / shading *
           (settings_.use_shadowing_function ? shadowing(m, light) : 1.0f);
}

Rgb BentNormal::eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    if (wo.z == 0.0f || wi.z == 0.0f) return Rgb(0.0f);
    const bool from_eye = mode == TransportMode::radiance;
    const Bent bent{frame_around(towards(unit_normal(p), from_eye ? wo : wi)), 1.0f};
    const float factor = visible_factor(bent.m(), from_eye ? wo : wi, from_eye ? wi : wo);
    if (factor == 0.0f) return Rgb(0.0f);
    return factor * stopped_fraction(p, bent, wo) *
           nested_->eval(seen_in(bent.frame, p), bent.frame.to_local(wo), bent.frame.to_local(wi), mode);
}

/// The normals that sample() chooses from. From the eye there is one. From a light the viewer's direction,
/// which decides whether the normal is turned over, is still to be sampled: both are tried, the turned one
/// the less the closer the two are. Chances are zero where the light is below.
std::array<BentNormal::Bent, 2> BentNormal::sampled_from(const Vec3& m, const Vec3& wo,
                                                         TransportMode mode) const {
    if (mode == TransportMode::radiance) return {{{frame_around(towards(m, wo)), 1.0f}, {Frame(), 0.0f}}};
    const Vec3 turned = turned_over(m);
    const float tilt = std::hypot(m.x, m.y);
    const bool plain = same_side(m, wo),
               over = settings_.flip_invalid_normals && tilt > 0.0f && same_side(turned, wo);
    const float probability = !over ? 0.0f : plain ? std::fmin(0.5f, tilt) : 1.0f;
    return {{{frame_around(m), plain ? 1.0f - probability : 0.0f}, {frame_around(turned), probability}}};
}

/// As much passes panes straight on as if nothing were bent: what the nested one scatters is scaled to the
/// rest.
float BentNormal::stopped_fraction(const BsdfPoint& p, const Bent& bent, const Vec3& wo) const {
    if (!traits_.pane) return 1.0f;
    const float stops = straight_passage_of(*nested_, seen_in(bent.frame, p), bent.frame.to_local(wo)).stops;
    return stops > 0.0f ? straight_passage(p, wo).stops / stops : 0.0f;
}

float BentNormal::pdf_solid_angle(const BsdfPoint& p, const Vec3& wo, const Vec3& wi,
                                  TransportMode mode) const {
    if (wo.z == 0.0f || wi.z == 0.0f) return 0.0f;
    const Vec3 m = unit_normal(p);
    const bool from_eye = mode == TransportMode::radiance;
    const Vec3 &eye = from_eye ? wo : wi, &light = from_eye ? wi : wo;
    if (visible_factor(towards(m, eye), eye, light) == 0.0f) return 0.0f;
    float sum = 0.0f;
    for (const Bent& bent : sampled_from(m, wo, mode))
        if (bent.chance > 0.0f && same_side(bent.m(), eye))
            sum += bent.chance * stopped_fraction(p, bent, wo) *
                   nested_->pdf_solid_angle(seen_in(bent.frame, p), bent.frame.to_local(wo),
                                            bent.frame.to_local(wi), mode);
    return sum;
}

std::optional<BsdfSample> BentNormal::sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                             TransportMode mode) const {
    const StraightPassage passage = straight_passage(p, wo);
    if (u_lobe >= passage.stops) return straight_sample(passage, wo);
    u_lobe = stretched(u_lobe, passage.stops);
    const Vec3 m = unit_normal(p);
    const auto both = sampled_from(m, wo, mode);
    const Bent& bent = both[u_lobe < both[0].chance ? 0 : 1];
    if (!(bent.chance > 0.0f)) return std::nullopt;
    u_lobe = stretched(u_lobe < both[0].chance ? u_lobe : u_lobe - both[0].chance, bent.chance);

    const BsdfPoint q = seen_in(bent.frame, p);
    const Vec3 o = bent.frame.to_local(wo);
    auto s = nested_->sample(q, o, u_lobe * straight_passage_of(*nested_, q, o).stops, u, mode);
    if (!s) return s;
    const float cos_m = std::fabs(s->wi.z);
    s->wi = glm::normalize(bent.frame.to_world(s->wi));
    if (wo.z == 0.0f || s->wi.z == 0.0f) return std::nullopt;
    const bool from_eye = mode == TransportMode::radiance;
    const Vec3 &eye = from_eye ? wo : s->wi, &light = from_eye ? s->wi : wo;
    const Vec3 seen = towards(m, eye);
    const float factor = visible_factor(seen, eye, light);
    if (factor == 0.0f || !same_side(bent.m(), eye)) return std::nullopt;
    if (!s->delta) {
        s->pdf_solid_angle = pdf_solid_angle(p, wo, s->wi, mode);
        if (!(s->pdf_solid_angle > 0.0f)) return std::nullopt;
        s->weight = eval(p, wo, s->wi, mode) * (std::fabs(s->wi.z) / s->pdf_solid_angle);
    } else {
        if (seen != bent.m()) return std::nullopt;  // this viewer sees the other one
        s->weight *= factor * (std::fabs(s->wi.z) / cos_m) / bent.chance;
    }
    if (is_black(s->weight)) return std::nullopt;
    return s;
}

Rgb BentNormal::albedo(const BsdfPoint& p, const Vec3& wo) const {
    const Frame frame = frame_around(towards(unit_normal(p), wo));
    if (!same_side(frame.n, wo)) return straight_passage(p, wo).transmittance();
    return nested_->albedo(seen_in(frame, p), frame.to_local(wo));
}

}  // namespace mote::core
