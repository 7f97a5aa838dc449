// One eye path of photon mapping: direct light by sampling, everything else by density estimates.
//
// The path goes through mirrors and glass to its first connectable vertex. Light that scattered at least
// twice comes from the photons: around the vertex on a surface, and along every ray in media, up to the first
// surface whether or not the path got there. Photons hold light that passed delta surfaces (caustics) as
// well.
#pragma once

#include <limits>

#include "gathering/photon_maps/volume_photon_map.h"
#include "integrators/eye_path/eye_path.h"

namespace mote::integrators {

/// The photons of one pass.
struct PhotonMaps {
    gathering::SurfacePhotonMap surface;
    gathering::VolumePhotonMap volume;
    gathering::DensityEstimate estimate;
    bool single_scattering = false;  ///< from photons, instead of next-event estimation at collisions
};

/// Memory that one task reuses between paths.
struct PhotonScratch {
    std::vector<core::KdTree::Neighbour> neighbours;
    std::vector<core::RayFacingDiscs::Hit> hits;
};

/// Photons of one kind.
enum class PhotonPlace : std::uint8_t { surface, medium };

/// For images, where the sums alone are wanted.
struct IgnorePhotons {
    void operator()(PhotonPlace, std::uint32_t /*photon*/, const core::Rgb& /*light*/) const {}
};

/// Calls visit(place, photon, light) with the light that each photon adds to the pixel.
template <bool Media, typename Visit = IgnorePhotons>
class PhotonEyePath {
  public:
    PhotonEyePath(const core::Scene& scene, const EyePathLimits& limits, const PhotonMaps& maps,
                  core::WalkContext& context, PhotonScratch& scratch, Visit visit = {})
        : scene_(scene), limits_(limits), maps_(maps), context_(context), scratch_(scratch), visit_(visit) {}

    /// Radiance along the eye ray, by layer.
    TransportSum trace(const EyeRay& eye) {
        TransportSum sum;
        EyePath<Media> path(scene_, limits_, eye, context_);
        const auto add_beam = [&](const EyeSegment& segment) {
            if (Media && wants_beams() && path.scatterings() == 0) this->add_beam(sum, segment, path.depth());
        };
        while (path.advance(context_, sum, add_beam)) {
            const bool surface = path.vertex().on_surface();
            if (!surface && maps_.single_scattering) break;  // the beam has it all
            if (!path.vertex().connectable()) continue;
            if (path.wants_connection()) sum[path.layer_of_connection()] += path.sample_light(context_);
            if (surface && limits_.wanted[Transport::indirect]) add_density(sum, path);
        }
        return sum;
    }

  private:
    /// Photons deeper than this would make the path longer than max_depth.
    int photon_depth(int eye_depth) const {
        return limits_.max_depth < 0 ? std::numeric_limits<int>::max() : limits_.max_depth - eye_depth;
    }

    bool wants_beams() const {
        return limits_.wanted[Transport::multiple_scattering] ||
               (maps_.single_scattering && limits_.wanted[Transport::single_scattering]);
    }

    void add_beam(TransportSum& sum, const EyeSegment& segment, int depth) {
        const core::Rgb throughput = lights::throughput_of<Media>(segment.before);
        const auto light = maps_.volume.radiance(segment.ray, segment.event.surface_distance, segment.start,
                                                 photon_depth(depth), context_, scratch_.hits,
                                                 [&](std::uint32_t photon, const core::Rgb& term) {
                                                     visit_(PhotonPlace::medium, photon, throughput * term);
                                                 });
        sum[Transport::single_scattering] += throughput * light.single;
        sum[Transport::multiple_scattering] += throughput * light.multiple;
    }

    void add_density(TransportSum& sum, const EyePath<Media>& path) {
        const core::Rgb throughput = path.throughput();
        sum[Transport::indirect] +=
            throughput * maps_.surface.radiance(path.vertex(), maps_.estimate, photon_depth(path.depth()),
                                                scratch_.neighbours,
                                                [&](std::uint32_t photon, const core::Rgb& term) {
                                                    visit_(PhotonPlace::surface, photon, throughput * term);
                                                });
    }

    const core::Scene& scene_;
    const EyePathLimits& limits_;
    const PhotonMaps& maps_;
    core::WalkContext& context_;
    PhotonScratch& scratch_;
    Visit visit_;
};

}  // namespace mote::integrators
