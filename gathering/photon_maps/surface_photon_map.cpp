#include "gathering/photon_maps/surface_photon_map.h"

#include <tbb/parallel_for.h>

namespace mote::gathering {

using namespace core;

SurfacePhotonMap::SurfacePhotonMap(std::vector<Photon> photons) {
    std::vector<Vec3> positions(photons.size());
    for (std::size_t i = 0; i < photons.size(); ++i) positions[i] = photons[i].position;
    tree_ = KdTree(positions);
    photons_.resize(photons.size());
    const auto order = tree_.order();
    tbb::parallel_for(std::size_t(0), photons.size(),
                      [&](std::size_t i) { photons_[i] = photons[order[i]]; });
    tree_.forget_order();
}

Rgb SurfacePhotonMap::radiance(const ScatteringVertex& receiver, const DensityEstimate& estimate,
                               int max_depth, std::vector<KdTree::Neighbour>& scratch) const {
    constexpr float min_normal_cosine = 0.5f;
    tree_.nearest(receiver.position, std::max<std::size_t>(estimate.neighbours, 2), infinity, scratch);
    if (scratch.size() < 2) return Rgb(0.0f);
    // Photons strictly inside r: never the k-th one, which set it.
    const float r2 = scratch.front().distance_squared * sqr(estimate.radius_fraction);
    if (!(r2 > 0.0f)) return Rgb(0.0f);
    const Vec3 normal = receiver.hit.geometric_normal;
    Rgb sum(0.0f);
    for (const KdTree::Neighbour& n : scratch) {
        if (!(n.distance_squared < r2)) continue;
        const Photon& photon = photons_[n.index];
        if (int(photon.depth) > max_depth) continue;
        if (std::fabs(glm::dot(decode_normal(photon.normal_or_medium), normal)) < min_normal_cosine) continue;
        const Vec3 wi = decode_direction(photon.towards_light);
        const float geometric = receiver.geometric_cosine(wi);
        if (!(geometric > 0.0f)) continue;
        // Photons measure light per area of the true surface; f* C* belongs to the shading normal.
        sum += photon.power * receiver.eval_cos(wi, TransportMode::radiance) / geometric;
    }
    return sum * (inv_pi / r2);  // kappa of Engelhardt 2013, Eq. 4.5
}

}  // namespace mote::gathering
