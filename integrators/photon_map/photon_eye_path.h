// One eye path of photon mapping: direct light by sampling, everything else by density estimates.
//
// The path goes through mirrors and glass to its first connectable vertex. Light that scattered at least
// twice comes from the photons: around the vertex on a surface, and along every ray in media, up to the first
// surface whether or not the path got there. Photons hold light that passed delta surfaces (caustics) as
// well.
#pragma once

#include <limits>

#include "gathering/photon_maps/volume_photon_map.h"
#include "integrators/eye_path/eye_roulette.h"
#include "integrators/path_tracing/path_kernel.h"
#include "lights/emitters/direct_light.h"

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

template <bool Media>
class PhotonEyePath {
  public:
    PhotonEyePath(const core::Scene& scene, const PathSettings& settings, const PhotonMaps& maps,
                  core::WalkContext& context, PhotonScratch& scratch)
        : scene_(scene), settings_(settings), maps_(maps), context_(context), scratch_(scratch) {}

    /// Radiance along `ray`, by layer. `state` holds the media at its origin.
    TransportSum trace(core::Ray ray, core::MediumState state, core::Sampler& sampler) {
        TransportSum sum;
        core::PathWeights weights;
        if constexpr (Media) weights.hero = std::min(int(context_.rng.next_float() * 3.0f), 2);
        float eta = 1.0f;
        for (int depth = 1; settings_.max_depth < 0 || depth <= settings_.max_depth; ++depth) {
            const core::MediumState start = state;
            const core::Rgb throughput =
                weights.throughput / lights::channel_average<Media>(weights.unidirectional);
            core::Rgb emitted(0.0f);
            const core::WalkEvent event = core::walk<Media>(scene_, ray, state, weights, emitted, context_);
            if constexpr (Media) add_beam(sum, throughput, ray, event, start, depth);
            sum[Transport::emission] +=
                emitted + lights::found_light<Media>(scene_, event, ray, weights, nullptr);
            if (event.kind == core::WalkEvent::Kind::escaped || depth == settings_.max_depth) break;

            const core::ScatteringVertex vertex = make_vertex(event, ray);
            const core::Vec2 choices = sampler.next_2d();  // of the light, and of the lobe
            const bool sampled = vertex.on_surface() || !maps_.single_scattering;
            const Transport direct = vertex.on_surface() ? Transport::direct : Transport::single_scattering;
            if (vertex.connectable()) {
                const core::Vec2 u = sampler.next_2d();
                if (sampled)
                    sum[direct] +=
                        lights::sample_light<Media>(scene_, vertex, weights, state, choices.x, u, context_);
                if (vertex.on_surface()) add_density(sum, weights, vertex, depth);
            }
            if (!sampled) break;
            if (depth >= settings_.rr_depth &&
                !survives<Media>(weights, eta, depth, context_.rng.next_float()))
                break;
            const auto next = vertex.sample(choices.y, sampler.next_2d(), core::TransportMode::radiance);
            if (!next) break;
            lights::apply_scattering<Media>(weights, *next, vertex.position);
            eta *= next->eta;
            if (Media && vertex.on_surface()) state = vertex.state_towards(state, next->wi);
            ray = core::Ray{vertex.ray_origin(next->wi), next->wi};
            if (next->delta) continue;
            sum[direct] +=
                lights::light_along<Media>(scene_, ray, state, weights, &vertex.position, context_);
            break;
        }
        return sum;
    }

  private:
    /// Photons deeper than this would make the path longer than max_depth.
    int photon_depth(int eye_depth) const {
        return settings_.max_depth < 0 ? std::numeric_limits<int>::max() : settings_.max_depth - eye_depth;
    }

    void add_beam(TransportSum& sum, const core::Rgb& throughput, const core::Ray& ray,
                  const core::WalkEvent& event, const core::MediumState& start, int depth) {
        const auto light = maps_.volume.radiance(ray, event.surface_distance, start, photon_depth(depth),
                                                 context_, scratch_.hits);
        sum[Transport::single_scattering] += throughput * light.single;
        sum[Transport::multiple_scattering] += throughput * light.multiple;
    }

    void add_density(TransportSum& sum, const core::PathWeights& weights,
                     const core::ScatteringVertex& vertex, int depth) {
        const core::Rgb throughput =
            weights.throughput / lights::channel_average<Media>(weights.unidirectional);
        sum[Transport::indirect] +=
            throughput *
            maps_.surface.radiance(vertex, maps_.estimate, photon_depth(depth), scratch_.neighbours);
    }

    const core::Scene& scene_;
    const PathSettings& settings_;
    const PhotonMaps& maps_;
    core::WalkContext& context_;
    PhotonScratch& scratch_;
};

}  // namespace mote::integrators
