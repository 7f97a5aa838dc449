// The eye paths of a 4x4 tile of pixels, advanced together to their connectable vertices, where all VPLs are
// gathered at once (lights/virtual_lights/vpl_gather.h).
#pragma once

#include <limits>
#include <optional>

#include "integrators/eye_path/eye_ray.h"
#include "integrators/eye_path/eye_roulette.h"
#include "integrators/path_tracing/path_kernel.h"
#include "integrators/virtual_point_lights/tile_compensation.h"
#include "integrators/virtual_point_lights/vpl_settings.h"
#include "lights/emitters/direct_light.h"
#include "lights/shadow_maps/shadow_map_gather.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::integrators {

/// One estimate of a pixel.
struct VplPixel {
    TransportSum transport;
    std::array<core::Rgb, 2> compensation{};  ///< of receivers on surfaces; in media

    void add(const VplPixel& other, float weight) {
        for (std::size_t i = 0; i < transport.light.size(); ++i)
            transport.light[i] += weight * other.transport.light[i];
        for (std::size_t i = 0; i < 2; ++i) compensation[i] += weight * other.compensation[i];
    }
};

/// Where shadow maps stand in for shadow rays; all null where they do not.
struct EyeShadowMaps {
    const lights::LightShadowMaps* lights = nullptr;
    lights::ReceiverStore* receivers = nullptr;  ///< takes the receivers instead of their gathering VPLs here
    int column = 0, row = 0;                     ///< pixel of the first lane
    float scale = 1.0f;                          ///< of the light at receivers
};

/// Advances the lanes from one connectable vertex to the next, until no eye path goes on.
template <bool Media>
class EyeTile {
  public:
    static constexpr int side = 4;
    static_assert(side * side == lights::ReceiverTile::width);

    EyeTile(const core::Scene& scene, const VplSettings& settings, float bound, const lights::VplSet& vpls,
            const compensation::ResidualTransport* transport, lights::GatherScratch& scratch,
            core::WalkContext& walk, const EyeShadowMaps& maps = {})
        : scene_(scene),
          settings_(settings),
          bound_(bound),
          vpls_(vpls),
          scratch_(scratch),
          walk_(walk),
          maps_(maps),
          compensation_(scene, settings.compensation, transport, vpls, scratch, walk) {}

    void start(int lane, const EyeRay& eye, const core::MediumState& state) {
        Lane& l = lanes_[std::size_t(lane)];
        l = Lane{};
        l.ray = eye.ray, l.sampler.emplace(eye.sampler), l.rng = eye.rng, l.state = state, l.alive = true;
        if constexpr (Media) l.weights.hero = std::min(int(l.rng.next_float() * 3.0f), 2);
    }
    void stop(int lane) { lanes_[std::size_t(lane)] = Lane{}; }
    const VplPixel& sum(int lane) const { return lanes_[std::size_t(lane)].sum; }
    CompensationCost compensation_cost() const { return compensation_.cost(); }

    /// Of the lanes to come: where they lie in the picture, and how much receivers that are stored count.
    void place(int column, int row, float scale) {
        maps_.column = column, maps_.row = row, maps_.scale = scale;
    }

    /// Follows the eye paths and gathers the VPLs of `range`, whose light counts `vpl_scale` times.
    void run(const lights::VplRange& range, float vpl_scale) {
        for (bool any = true; any;) {
            receivers_.clear();
            any = false;
            for (int i = 0; i < lights::ReceiverTile::width; ++i) {
                Lane& lane = lanes_[std::size_t(i)];
                if (lane.alive) lane.alive = advance(lane, i);
                any |= lane.alive;
            }
            lights::TileLight light{};
            if (maps_.receivers)
                maps_.receivers->add(receivers_, maps_.column, maps_.row, range, vpl_scale * maps_.scale);
            else
                light = lights::gather({scene_, scratch_, walk_.rays, walk_.tracking}, vpls_, range,
                                       lights::BoundedGeometry{bound_}, receivers_);
            const auto compensated = compensation_.run(range, vpl_scale);
            for (int i = 0; i < lights::ReceiverTile::width; ++i) {
                Lane& lane = lanes_[std::size_t(i)];
                lane.sum.transport[lane.receiver_layer] += vpl_scale * light[std::size_t(i)];
                lane.sum.compensation[lane.receiver_layer == Transport::indirect ? 0 : 1] +=
                    compensated[std::size_t(i)];
            }
        }
    }

  private:
    struct Lane {
        core::Ray ray;
        std::optional<core::Sampler> sampler;
        core::Rng rng;
        core::MediumState state;
        core::PathWeights weights;
        core::ScatteringVertex vertex;  ///< of the current receiver
        VplPixel sum;
        Transport receiver_layer = Transport::indirect;
        int depth = 0;
        float eta = 1.0f;
        bool alive = false;
    };

    /// Follows one eye path to its next vertex; makes it a receiver where it can be connected. Returns
    /// whether the path goes on behind it, through a mirror or glass.
    bool advance(Lane& lane, int index) {
        walk_.rng = lane.rng;
        const bool goes_on = advance_with_rng(lane, index);
        lane.rng = walk_.rng;
        return goes_on;
    }

    bool advance_with_rng(Lane& lane, int index) {
        const int max_depth = settings_.eye.max_depth;
        ++lane.depth;
        core::Rgb emitted(0.0f);
        const core::WalkEvent event =
            core::walk<Media>(scene_, lane.ray, lane.state, lane.weights, emitted, walk_);
        lane.sum.transport[Transport::emission] +=
            emitted + lights::found_light<Media>(scene_, event, lane.ray, lane.weights, nullptr);
        if (event.kind == core::WalkEvent::Kind::escaped || lane.depth == max_depth) return false;

        lane.vertex = make_vertex(event, lane.ray);
        const bool surface = lane.vertex.on_surface();
        const Transport direct = surface ? Transport::direct : Transport::single_scattering;
        const core::Vec2 choices = lane.sampler->next_2d();  // of the light, and of the lobe
        if (lane.vertex.connectable()) {
            lane.sum.transport[direct] +=
                lights::sample_light<Media>(scene_, lane.vertex, lane.weights, lane.state, choices.x,
                                            lane.sampler->next_2d(), walk_, false, maps_.lights);
            add_receiver(lane, index);
        }
        if (lane.depth >= settings_.eye.rr_depth &&
            !survives<Media>(lane.weights, lane.eta, lane.depth, walk_.rng.next_float()))
            return false;
        const auto next =
            lane.vertex.sample(choices.y, lane.sampler->next_2d(), core::TransportMode::radiance);
        if (!next) return false;
        lights::apply_scattering<Media>(lane.weights, *next, lane.vertex.position);
        lane.eta *= next->eta;
        if (Media && surface) lane.state = lane.vertex.state_towards(lane.state, next->wi);
        lane.ray = core::Ray{lane.vertex.ray_origin(next->wi), next->wi};
        if (next->delta) return true;
        lane.sum.transport[direct] += lights::light_along<Media>(scene_, lane.ray, lane.state, lane.weights,
                                                                 &lane.vertex.position, walk_);
        return false;
    }

    void add_receiver(Lane& lane, int index) {
        const int max_depth = settings_.eye.max_depth;
        const std::int32_t vpl_depth =
            max_depth < 0 ? std::numeric_limits<std::int32_t>::max() : max_depth - lane.depth - 1;
        lane.receiver_layer = lane.vertex.on_surface() ? Transport::indirect : Transport::multiple_scattering;
        const core::Rgb throughput =
            lane.weights.throughput / lights::channel_average<Media>(lane.weights.unidirectional);
        receivers_.set(index, lane.vertex, throughput, lane.state, core::Rng(walk_.rng.next_u32()),
                       vpl_depth);
        compensation_.add(index, lane.vertex, throughput, lane.state, vpl_depth);
    }

    const core::Scene& scene_;
    const VplSettings& settings_;
    float bound_;
    const lights::VplSet& vpls_;
    lights::GatherScratch& scratch_;
    core::WalkContext& walk_;
    EyeShadowMaps maps_;
    TileCompensation<Media> compensation_;
    std::array<Lane, lights::ReceiverTile::width> lanes_;
    lights::ReceiverTile receivers_;
};

}  // namespace mote::integrators
