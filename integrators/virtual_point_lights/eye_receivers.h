// Receivers of virtual point lights on sixteen eye paths: their connectable vertices.
//
// With scattering points a path continues to its first surface, and has receivers there and at K points of
// the media before it (core/scene/scattering_points.h): at each of them the light of lights, and every K-th
// VPL, which counts K times. So the points of a ray cost no more VPLs than one collision does. Which point
// meets which VPLs is random, so that the sum is unbiased.
#pragma once

#include <algorithm>

#include "integrators/eye_path/image_loop.h"
#include "integrators/virtual_point_lights/vpl_settings.h"

namespace mote::integrators {

/// Follows the eye paths of a packet. What is done at receivers is that of the derived class.
template <bool Media>
class EyeReceivers {
  public:
    using Packet = EyePacket<Media>;
    static_assert(Packet::width == lights::ReceiverTile::width);

    /// `maps`: of the lights; null where these are traced.
    EyeReceivers(const VplSettings& settings, Packet& packet, const lights::LightShadowMaps* maps)
        : settings_(settings), packet_(packet), walk_(packet.walk()), maps_(maps) {}
    virtual ~EyeReceivers() = default;

    /// The settings of the packet.
    static EyePacketSettings packet_settings(const VplSettings& settings) {
        EyePacketSettings packet{.limits = settings.eye};
        const bool wants_points = settings.eye.wanted[Transport::single_scattering] ||
                                  settings.eye.wanted[Transport::multiple_scattering];
        if (settings.scattering_points > 0)
            packet.scattering_points = wants_points ? settings.scattering_points : 0;
        return packet;
    }

    /// Follows the paths to their ends. Receivers gather the VPLs of `range`, whose light counts `vpl_scale`
    /// times. `gathers` false: they are only recorded for the pixels around.
    void follow(const lights::VplRange& range, float vpl_scale, bool gathers = true) {
        gathers_ = gathers;
        packet_.run([&] {
            points_.fill({});
            packet_.for_each([&](int i, Lane& lane) { begin_step(i, lane); });
            packet_.sample_lights({false, maps_});
            packet_.for_each([&](int i, Lane& lane) { receive(i, lane); });
            gather(range, vpl_scale);
            if constexpr (Media) gather_at_points(range, vpl_scale);
        });
    }

  protected:
    using Lane = typename Packet::Lane;
    template <typename T>
    using PerLane = std::array<T, lights::ReceiverTile::width>;

    /// A vertex is the lane's receiver, until gather(). `throughput` is the weight of the eye path up to it,
    /// `depth` the largest depth of its VPLs.
    virtual void add(int lane, const core::ScatteringVertex& vertex, const core::Rgb& throughput,
                     const core::MediumState& state, std::int32_t depth) = 0;
    /// The light of VPLs at the receivers since the last call.
    virtual void gather(const lights::VplRange& range, float vpl_scale) = 0;
    /// So many of a ray's scattering points are receivers.
    virtual std::size_t max_points() const { return 2; }

    const VplSettings& settings_;
    Packet& packet_;
    core::WalkContext& walk_;

  private:
    /// gather() at the scattering points, the n-th of every lane at once. VPLs are shared out among a few of
    /// them.
    void gather_at_points(const lights::VplRange& range, float vpl_scale) {
        if (std::all_of(points_.begin(), points_.end(), [](const auto& points) { return points.empty(); }))
            return;
        const auto count = std::size_t(settings_.scattering_points);
        const std::size_t receivers = std::min(count, max_points()), spacing = count / receivers;
        const std::size_t shares = settings_.selection->takes_all() ? receivers : 1;
        for (std::size_t n = 0; n < count; ++n) {
            const bool receives = n % spacing == 0 && n / spacing < receivers;
            for (int i = 0; i < Packet::width; ++i)
                if (const auto& points = points_[std::size_t(i)]; !points.empty())
                    at_point(i, points[n], receives ? float(count) / float(receivers) : 0.0f);
            const std::size_t first = shares > 1 ? range.first + n / spacing * range.stride : range.first;
            if (receives) gather({first, range.stride * shares, range.end}, vpl_scale * float(shares));
        }
    }

    /// Chooses the scattering points of the last segment, and ends paths that carry little.
    void begin_step(int index, Lane& lane) {
        if (!Media || !lane.points) return;
        EyePath<Media>& path = *lane.path;
        if (path.may_continue()) points_[std::size_t(index)] = lane.points->choose(rare_light);
        lane.alive = lane.alive && (path.scatterings() > 0 || survives(path));
    }
    /// The vertex becomes a receiver where it can be connected. Engelhardt 2013, Eq. 10.9: tau sigma_s / p(t)
    /// of one in a medium is in the throughput. The print leaves out sigma_s (docs/errata.md).
    void receive(int index, Lane& lane) {
        EyePath<Media>& path = *lane.path;
        if (!lane.alive || !path.vertex().connectable() ||
            !settings_.eye.wanted[transport_layer(2, path.vertex().on_surface())])
            return;
        see_receiver(lane.seen, path);
        add_receiver(index, path.vertex(), path.throughput(), path.state());
    }
    /// If true, a path whose media let little through continues behind them: by chance, which its weight
    /// makes up for.
    bool survives(EyePath<Media>& path) {
        const float stays = std::max(core::max_component(path.throughput()) / rare_light, min_survival);
        if (stays >= 1.0f) return true;
        if (!(walk_.rng.next_float() < stays)) return false;
        path.scale(1.0f / stays);
        return true;
    }

    /// Light of lights at a point. `share` above 0: it is a receiver, too, and counts as so many points.
    void at_point(int index, const core::ScatteringPoint& point, float share) {
        if (core::is_black(point.weight)) return;
        Lane& lane = packet_[index];
        walk_.rng = lane.rng;
        const core::MediumState& state = lane.points->state_of(point);
        core::ScatteringVertex& vertex = vertices_[std::size_t(index)];
        vertex = lane.path->vertex_at(point.position, state);
        if (settings_.eye.wanted[Transport::single_scattering])
            lane.sum[Transport::single_scattering] +=
                lane.path->light_at(vertex, point.weight, state, walk_, {false, maps_});
        if (share > 0.0f && settings_.eye.wanted[Transport::multiple_scattering]) {
            if (lane.path->depth() == 1 && lane.seen.volume.shared)
                lane.seen.volume.modulation += share * point.weight;
            add_receiver(index, vertex, share * point.weight, state);
        }
        lane.rng = walk_.rng;
    }

    void add_receiver(int index, const core::ScatteringVertex& vertex, const core::Rgb& throughput,
                      const core::MediumState& state) {
        if (gathers_)
            add(index, vertex, throughput, state, settings_.eye.light_depth(packet_[index].path->depth()));
    }

    /// Eye paths and scattering points that carry less than this share of the light are followed by chance:
    /// VPLs by the hundred cost the same wherever they are gathered.
    static constexpr float rare_light = 0.3f;
    /// Behind thick media, which may be all that the eye sees, so many paths are followed at least.
    static constexpr float min_survival = 1.0f / 32.0f;

    const lights::LightShadowMaps* maps_;
    PerLane<std::span<const core::ScatteringPoint>> points_;  ///< of the last segments
    PerLane<core::ScatteringVertex> vertices_;                ///< at one of them
    bool gathers_ = true;
};

}  // namespace mote::integrators
