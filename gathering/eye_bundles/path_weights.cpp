#include "gathering/eye_bundles/path_weights.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace mote::gathering {

using namespace core;
using lights::VirtualPointLight;

namespace {

const lights::VplDetail* detail_of(const lights::VplSet& vpls, const VirtualPointLight& vpl) {
    return vpl.detail == VirtualPointLight::no_detail ? nullptr : &vpls.details[vpl.detail];
}

/// 0 <= ratio <= certain, where 0/0 is 0.
float ratio_of(float numerator, float denominator) {
    if (!(numerator > 0.0f)) return 0.0f;
    return denominator > 0.0f ? std::min(numerator / denominator, certain) : certain;
}

/// The step from z to y, neighbouring VPLs of a path, per area.
struct Step {
    float light;  ///< p(z -> y); 0 where z does not shine on y
    float eye;    ///< c e(y -> z)
};
Step step_between(const lights::VplSet& vpls, const VirtualPointLight& z, const VirtualPointLight& y,
                  float continued) {
    const Vec3 to_y = y.position - z.position;
    const float d2 = std::max(glm::dot(to_y, to_y), 1e-30f);
    const Vec3 direction = to_y / std::sqrt(d2);
    const lights::VplDetail *before = detail_of(vpls, z), *here = detail_of(vpls, y);
    const float cos_y = std::fabs(glm::dot(y.shading_normal, direction));
    const float cos_z =
        before ? before->vertex.geometric_cosine(direction) : std::max(0.0f, glm::dot(z.normal, direction));
    const float g = cos_y * cos_z / d2;
    const bool continues = !here || may_continue(here->vertex);
    return {next_vertex_pdf(before, direction, g, cos_y, d2),
            continues ? continued * continued_pdf(g) : 0.0f};
}

}  // namespace

float connection_over_emission(const LitScene& scene, const LightReceiver& y, const Vec3& normal,
                               const lights::LightStart& start) {
    if (!start.emitter) return 0.0f;
    const Emitter& light = *start.emitter;
    const EmitterTraits traits = light.traits();
    const bool far = traits.infinite || traits.delta_direction;
    Vec3 direction = start.direction;
    float d2 = 1.0f;
    if (!far) {
        const Vec3 to_y = y.position - start.origin;
        d2 = std::max(glm::dot(to_y, to_y), 1e-30f);
        direction = to_y / std::sqrt(d2);
    }
    // p(z | y): a choice of the light, and of a direction to it, per solid angle; 1 where it has no extent.
    float connection = scene.light_probability(y, &light);
    // p(z -> y) of the same z: per area at z, or per solid angle at y as the connection is.
    const EmissionDensity density =
        light.pdf_emission(far ? y.position : start.origin, start.normal, direction);
    float emission = scene.probability_by_power(&light) * density.pdf_area * density.pdf_solid_angle *
                     std::fabs(glm::dot(normal, direction));
    if (traits.can_be_hit()) {
        SurfaceHit hit;
        hit.position = start.origin, hit.geometric_normal = start.normal, hit.t = std::sqrt(d2);
        connection *= light.pdf_direct(y.position, -direction, far ? nullptr : &hit);
        if (!far) connection *= std::fabs(glm::dot(start.normal, direction));  // |cos| / d^2, as below
    }
    return ratio_of(connection, traits.delta_position ? emission / d2 : emission);
}

FewerFound fewer_than_one(const TechniqueSamples& samples, float found) {
    return {samples.light_probability / std::max(samples.directions * found, 1e-30f), 0.0f};
}

FewerFound fewer_than_next(const TechniqueSamples& samples, const ScatteringVertex& y,
                           const FewerFound& fewer, const ScatteringVertex& next) {
    const Vec3 to_next = next.position - y.position;
    const float d2 = std::max(glm::dot(to_next, to_next), 1e-30f);
    const Vec3 direction = to_next / std::sqrt(d2);
    const float cos_y = y.shading_cosine(direction), cos_next = next.geometric_cosine(direction);
    const float made = samples.continued * continued_pdf(cos_y * cos_next / d2);
    const float plain = std::min(samples.joined_probability / std::max(made, 1e-30f), certain);
    // p(next -> y) b / (c e(y -> next)): |y - next| and the cosine at y are in both, and for a plain surface
    // that at next, too. No quotient of what may be 0, where the points are one.
    const float onward = std::min(fewer.from(y, direction) / samples.continued, certain);
    if (next.diffuse_reflectance()) return {plain + onward, 0.0f};
    return {plain, onward * pi / std::max(cos_next, 1e-6f)};
}

namespace {

/// a_j = alone + onward a_{j-1}.
struct Rival {
    float alone = 0.0f, onward = 0.0f;
};

Rival rival_of(const LitScene& scene, const lights::VplSet& vpls, const TechniqueSamples& samples,
               std::size_t j) {
    const VirtualPointLight& y = vpls.lights[j];
    if (y.depth == 1) {
        const lights::VplDetail* detail = detail_of(vpls, y);
        const LightReceiver at =
            detail ? detail->vertex.light_receiver() : LightReceiver{y.position, y.normal};
        const float ratio = connection_over_emission(scene, at, y.normal, vpls.starts[y.path]);
        return {ratio_of(samples.directions * ratio, samples.paths * samples.light_probability)};
    }
    // Behind a mirror there is no VPL that bundles could join.
    if (j == 0 || vpls.lights[j - 1].path != y.path || vpls.lights[j - 1].depth + 1 != y.depth) return {};
    const Step step = step_between(vpls, vpls.lights[j - 1], y, samples.continued);
    return {ratio_of(samples.directions * samples.joined_probability, samples.light_probability * step.light),
            ratio_of(step.eye, step.light)};
}

}  // namespace

std::vector<float> rivals_of(const LitScene& scene, const lights::VplSet& vpls,
                             const TechniqueSamples& samples) {
    std::vector<Rival> of(vpls.lights.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, of.size(), 256), [&](const auto& range) {
        for (std::size_t j = range.begin(); j < range.end(); ++j) of[j] = rival_of(scene, vpls, samples, j);
    });
    std::vector<float> rivals(of.size());
    for (std::size_t j = 0; j < of.size(); ++j) {
        rivals[j] = of[j].alone;
        if (of[j].onward > 0.0f) rivals[j] += of[j].onward * rivals[j - 1];  // Eq. (1)
        rivals[j] = std::min(rivals[j], certain);
    }
    return rivals;
}

}  // namespace mote::gathering
