// The eye paths of a 4x4 tile of pixels, advanced together to their connectable vertices, where all VPLs are
// gathered at once (lights/virtual_lights/vpl_gather.h).
#pragma once

#include <limits>
#include <optional>

#include "integrators/eye_path/eye_path.h"
#include "integrators/virtual_point_lights/tile_compensation.h"
#include "integrators/virtual_point_lights/vpl_settings.h"
#include "lights/shadow_maps/shadow_map_gather.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::integrators {

/// Where a receiver lies: the layers of compensation are named after it.
enum class ReceiverKind : std::uint8_t { surface, medium };

/// One estimate of a pixel.
struct VplPixel {
    TransportSum transport;
    std::array<core::Rgb, 2> compensation{};  ///< by ReceiverKind

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

    void start(int lane, const EyeRay& eye) {
        Lane& l = lanes_[std::size_t(lane)];
        l.sum = {}, l.receiver = ReceiverKind::surface, l.alive = true;
        walk_.rng = eye.rng;
        l.path.emplace(scene_, settings_.eye, eye, walk_);
        l.rng = walk_.rng;
    }
    void stop(int lane) {
        Lane& l = lanes_[std::size_t(lane)];
        l.sum = {}, l.alive = false;
    }
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
                // The sum over VPLs of Eqs. 10.4 and 10.5, with min(G*, b).
                light = lights::gather({scene_, scratch_, walk_.rays, walk_.tracking, walk_.cancelled}, vpls_,
                                       range, lights::BoundedGeometry{bound_}, receivers_);
            const auto compensated = compensation_.run(range, vpl_scale);
            for (int i = 0; i < lights::ReceiverTile::width; ++i) {
                Lane& lane = lanes_[std::size_t(i)];
                const bool surface = lane.receiver == ReceiverKind::surface;
                lane.sum.transport[transport_layer(2, surface)] += vpl_scale * light[std::size_t(i)];
                lane.sum.compensation[std::size_t(lane.receiver)] += compensated[std::size_t(i)];
            }
        }
    }

  private:
    struct Lane {
        std::optional<EyePath<Media>> path;
        core::Rng rng;  ///< of the path, while other lanes advance
        VplPixel sum;
        ReceiverKind receiver = ReceiverKind::surface;
        bool alive = false;
    };

    /// Follows one eye path to its next vertex; makes it a receiver where it can be connected. Returns
    /// whether there is one.
    bool advance(Lane& lane, int index) {
        walk_.rng = lane.rng;
        EyePath<Media>& path = *lane.path;
        const bool at_vertex = path.advance(walk_, lane.sum.transport);
        if (at_vertex && path.vertex().connectable()) {
            if (path.wants_connection())
                lane.sum.transport[path.layer_of_connection()] +=
                    path.sample_light(walk_, {false, maps_.lights});
            if (settings_.eye.wanted[transport_layer(2, path.vertex().on_surface())])
                add_receiver(lane, index);
        }
        lane.rng = walk_.rng;
        return at_vertex;
    }

    void add_receiver(Lane& lane, int index) {
        EyePath<Media>& path = *lane.path;
        const int max_depth = settings_.eye.max_depth;
        const std::int32_t vpl_depth =
            max_depth < 0 ? std::numeric_limits<std::int32_t>::max() : max_depth - path.depth() - 1;
        lane.receiver = path.vertex().on_surface() ? ReceiverKind::surface : ReceiverKind::medium;
        // Engelhardt 2013, Eq. 10.9: tau sigma_s / p(t) of a receiver in a medium is in the throughput. The
        // print leaves out sigma_s (docs/errata.md).
        const core::Rgb throughput = path.throughput();
        receivers_.set(index, path.vertex(), throughput, path.state(), core::Rng(walk_.rng.next_u32()),
                       vpl_depth);
        compensation_.add(index, path.vertex(), throughput, path.state(), vpl_depth);
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
