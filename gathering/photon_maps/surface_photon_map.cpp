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

float SurfacePhotonMap::find_photons(const ScatteringVertex& receiver, const DensityEstimate& estimate,
                                     std::vector<KdTree::Neighbour>& found) const {
    tree_.nearest(receiver.position, std::max<std::size_t>(estimate.neighbours, 2), infinity, found);
    // Photons strictly inside r: never the k-th one, which set it.
    return found.size() < 2 ? 0.0f : found.front().distance_squared * sqr(estimate.radius_fraction);
}

Rgb SurfacePhotonMap::reflected(const Photon& photon, const ScatteringVertex& receiver, int max_depth) {
    if (int(photon.depth) > max_depth) return Rgb(0.0f);
    if (!photon_counts(decode_normal(photon.normal_or_medium), receiver.hit.geometric_normal))
        return Rgb(0.0f);
    const Vec3 wi = decode_direction(photon.towards_light);
    const float geometric = receiver.geometric_cosine(wi);
    if (!(geometric > 0.0f)) return Rgb(0.0f);
    // Photons measure light per area of the true surface; f* C* belongs to the shading normal.
    return photon.power * receiver.eval_cos(wi, TransportMode::radiance) / geometric;
}

}  // namespace mote::gathering
