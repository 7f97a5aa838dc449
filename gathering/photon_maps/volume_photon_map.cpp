#include "gathering/photon_maps/volume_photon_map.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace mote::gathering {

using namespace core;

namespace {

/// A few neighbours estimate the density well enough for a radius, and cost less than many (Jarosz et al.
/// 2008).
constexpr std::size_t pilot_neighbours = 8;

/// Radius that would hold `wanted` photons at the density around photon `i`: volumes grow as numbers.
float radius_of(const KdTree& tree, std::uint32_t i, std::size_t wanted, float largest,
                std::vector<KdTree::Neighbour>& scratch) {
    tree.nearest(tree.point(i), std::min(pilot_neighbours, wanted) + 1, infinity, scratch);  // itself is one
    if (scratch.size() < 2) return largest;
    const double ratio = double(wanted) / double(scratch.size() - 1);
    const double distance = std::sqrt(double(scratch.front().distance_squared));
    return float(std::min(double(largest), distance * std::cbrt(ratio)));
}

}  // namespace

VolumePhotonMap::VolumePhotonMap(const RayQueries& scene, std::vector<Photon> photons,
                                 const DensityEstimate& estimate, float largest_radius)
    : scene_(&scene) {
    std::vector<Vec3> positions(photons.size());
    for (std::size_t i = 0; i < photons.size(); ++i) positions[i] = photons[i].position;
    KdTree tree(positions);
    const auto order = tree.order();
    photons_.resize(photons.size());
    std::vector<RayFacingDiscs::Disc> discs(photons.size());
    const float smallest = 1e-6f * largest_radius;  // photons that coincide
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, photons.size(), 256), [&](const auto& range) {
        std::vector<KdTree::Neighbour> scratch;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            photons_[i] = photons[order[i]];
            const float r = radius_of(tree, std::uint32_t(i), estimate.neighbours, largest_radius, scratch);
            discs[i] = {photons_[i].position, std::max(smallest, r * estimate.radius_fraction)};
        }
    });
    discs_.build(std::move(discs));
}

Rgb VolumePhotonMap::scattered(std::uint32_t index, const Rgb& transmittance, const Vec3& wo) const {
    const Photon& photon = photons_[index];
    const PhaseFunction& phase = scene_->media()[photon.normal_or_medium]->phase();
    const float r2 = sqr(discs_.discs()[index].radius);
    return transmittance * photon.power * phase.eval(wo, decode_direction(photon.towards_light)) *
           (inv_pi / r2);
}

}  // namespace mote::gathering
