// Guided paths of a wavefront: what lights/guiding adds at vertices, as EyePath has it.
#include "integrators/path_tracing/wavefront.h"

namespace mote::integrators {

using namespace core;

const lights::VmfMixture& Wavefront::lobes(int i) const {
    static const lights::VmfMixture none{};
    return guided_ ? lobes_[std::size_t(i)] : none;
}

/// The guide's directions at all vertices.
void Wavefront::find_guides() {
    for (int i = 0; i < rays_.count; ++i) {
        if (kind_[i] == Kind::ended) continue;
        if (kind_[i] == Kind::lambertian) {  // what guides read of a vertex
            vertex_.position = hits_.position.get(i), vertex_.wo = wo(i);
            vertex_.bsdf = hits_.shape[i]->bsdf.get();
            vertex_.hit.shading.n = hits_.shading_normal.get(i);
        }
        const ScatteringVertex& vertex = kind_[i] == Kind::other ? others_[std::size_t(i)] : vertex_;
        lights::VmfMixture& lobes = lobes_[std::size_t(i)];
        lobes.empty = true;
        if (guide_ratio_[i] >= lights::min_guide_ratio) guide_.find(vertex, lobes);
        own_probability_[i] = lobes.empty ? 1.0f : 1.0f - lights::guide_probability;
    }
}

/// Densities of the guide for the directions of sampled lights, for weight_lambertian().
void Wavefront::weight_guides_to_lights() {
    for (int i = 0; i < rays_.count; ++i) {
        guide_to_light_[i] = 0.0f;
        if (kind_[i] == Kind::lambertian && connects_[i] && !lobes(i).empty)
            guide_to_light_[i] = lights::guide_probability * lobes(i).pdf_solid_angle(to_light_.get(i));
    }
}

/// Lambertian vertices: directions of the guide instead of those of the cosine, by chance, and the density of
/// both together.
void Wavefront::sample_guides() {
    for (int i = 0; i < rays_.count; ++i) {
        next_weight_[i] = 1.0f;
        if (kind_[i] != Kind::lambertian || lobes(i).empty) continue;
        if (constexpr float p = lights::guide_probability; u_lobe_[i] < p) {
            const Vec3 wi = lobes(i).sample(u_lobe_[i] / p, {u_scatter_x_[i], u_scatter_y_[i]});
            const Vec3 ng = hits_.geometric_normal.get(i), ns = hits_.shading_normal.get(i);
            const Vec3 towards = rays_.direction.get(i);
            const float cosine = glm::dot(ns, wi);
            const bool reflected =
                reflects(-glm::dot(ns, towards), cosine, -glm::dot(ng, towards), glm::dot(ng, wi)) > 0.0f;
            next_pdf_[i] = reflected ? std::fabs(cosine) * inv_pi : 0.0f;
            next_direction_.set(i, wi);
            next_origin_.set(i, offset_origin(hits_.position.get(i), ng, hits_.error[i], wi));
        }
        if (!(next_pdf_[i] > 0.0f)) continue;
        const float pdf = lights::guided_pdf(lobes(i), next_direction_.get(i), next_pdf_[i]);
        next_weight_[i] = next_pdf_[i] / pdf, next_pdf_[i] = pdf;
    }
}

}  // namespace mote::integrators
