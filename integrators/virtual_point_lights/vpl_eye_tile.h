// Callbacks of the eye paths of `mote_vpl`: all VPLs are gathered at connectable vertices
// (lights/virtual_lights/vpl_gather.h), and what the bound removes is restored.
//
// With scattering points a path continues to its first surface, and gathers there and at K points of the
// media before it (core/scene/scattering_points.h): at each of them the light of lights, and every K-th VPL,
// which counts K times. So the points of a ray cost no more VPLs than one collision does. Which point meets
// which VPLs is random, so that the sum is unbiased.
#pragma once

#include <algorithm>

#include "integrators/eye_path/image_loop.h"
#include "integrators/virtual_point_lights/tile_compensation.h"
#include "integrators/virtual_point_lights/vpl_pixel.h"
#include "integrators/virtual_point_lights/vpl_settings.h"
#include "lights/selection/selection.h"

namespace mote::integrators {

template <bool Media>
class EyeTile {
  public:
    using Packet = EyePacket<Media>;
    static_assert(Packet::width == lights::ReceiverTile::width);

    EyeTile(const core::Scene& scene, const VplSettings& settings, const lights::VplSet& vpls,
            const lights::VplSelector& selector, const compensation::ResidualTransport* transport,
            Packet& packet, const EyeShadowMaps& maps = {})
        : scene_(scene),
          settings_(settings),
          packet_(packet),
          walk_(packet.walk()),
          scratch_(std::make_unique<lights::GatherScratch>()),
          maps_(maps),
          selector_(selector.for_task()),
          compensation_(scene, settings.compensation, transport, vpls, *scratch_, walk_) {}

    /// The settings of the packet.
    static EyePacketSettings packet_settings(const VplSettings& settings) {
        EyePacketSettings packet{.limits = settings.eye};
        const bool wants_points = settings.eye.wanted[Transport::single_scattering] ||
                                  settings.eye.wanted[Transport::multiple_scattering];
        if (settings.scattering_points > 0)
            packet.scattering_points = wants_points ? settings.scattering_points : 0;
        return packet;
    }

    /// From now on receivers are appended to these, and gather no VPLs.
    void record_receivers(std::vector<lights::PathReceiver>& all) { recorded_ = &all; }
    CompensationCost compensation_cost() const { return compensation_.cost(); }
    std::uint64_t imperfect_lookups() const { return imperfect_lookups_; }
    const lights::TileSelector& selector() const { return *selector_; }

    /// Follows the eye paths and gathers the VPLs of `range`, whose light counts `vpl_scale` times.
    /// `gathers` false: receivers are only recorded for the pixels around.
    void run(const lights::VplRange& range, float vpl_scale, bool gathers = true) {
        gathers_ = gathers;
        packet_.run([&] {
            receivers_.clear(), points_.fill({});
            packet_.for_each([&](int i, Lane& lane) { begin_step(i, lane); });
            packet_.sample_lights({false, maps_.lights});
            packet_.for_each([&](int i, Lane& lane) { receive(i, lane); });
            gather(range, vpl_scale);
            if constexpr (Media) gather_at_points(range, vpl_scale);
        });
    }
    /// run() for one of the eye samples of these pixels, with their share of the VPLs.
    void run(const PacketPixels& pixels) {
        const int samples = settings_.eye_paths();
        const bool all = settings_.selection->takes_all(), shared_out = settings_.vpls_shared_out();
        const auto places = std::size_t(settings_.interleaving) * std::size_t(settings_.interleaving);
        // Selected VPLs are not shared out: any of them may be selected, and neighbours select their own.
        const std::size_t share = all ? pixels.share : 0, shares = all ? places : 1;
        const std::size_t sample = shared_out ? std::size_t(pixels.sample) : 0,
                          parts = shared_out ? std::size_t(samples) : 1;
        maps_.column = pixels.pixels[0].x, maps_.row = pixels.pixels[0].y;
        maps_.spacing = settings_.interleaving, maps_.scale = 1.0f / float(samples);
        if (pixels.sample == 0) restored_ = {};
        run({sample + parts * share, parts * shares}, float(parts * shares), pixels.gathers);
        if (pixels.sample + 1 == samples) gather_recorded();
    }
    /// Compensation of a lane's pixel by ReceiverKind, summed over its eye samples.
    const std::array<core::Rgb, 2>& restored(std::size_t lane) const { return restored_[lane]; }

    /// Gathers at all points since the last call, where the selector gathers the points of a pixel at once:
    /// those of several eye paths, too, whose light is a sum.
    void gather_recorded() {
        if (!selector_->records()) return;
        const lights::LightByKind light = selector_->gather_recorded(context(), walk_.rng);
        for (int i = 0; i < Packet::width; ++i)
            for (const bool surface : {true, false})
                packet_[i].sum[transport_layer(2, surface)] += light[surface ? 0 : 1][std::size_t(i)];
    }

  private:
    using Lane = typename Packet::Lane;

    /// The sum over VPLs of Eqs. 10.4 and 10.5, with min(G*, b), and compensation, at all receivers.
    void gather(const lights::VplRange& range, float vpl_scale) {
        lights::TileLight light{};
        if (maps_.receivers)
            maps_.receivers->add(receivers_, maps_.column, maps_.row, maps_.spacing, range,
                                 vpl_scale * maps_.scale);
        else if (selector_->records())
            selector_->record(receivers_);
        else
            light = gather_selected(range);
        const auto compensated = compensation_.run(range, vpl_scale);
        for (std::size_t i = 0; i < light.size(); ++i) {
            const bool surface = kinds_[i] == lights::ReceiverKind::surface;
            packet_[int(i)].sum[transport_layer(2, surface)] += vpl_scale * light[i];
            restored_[i][std::size_t(kinds_[i])] += compensated[i];
        }
    }

    lights::GatherContext context() {
        return {scene_, *scratch_, walk_.rays, walk_.tracking, walk_.cancelled};
    }

    lights::TileLight gather_selected(const lights::VplRange& range) {
        const lights::GatherContext own = context();
        if (!maps_.imperfect) {
            lights::TracedVisibility visibility(own, receivers_);
            return selector_->gather(own, receivers_, range, visibility, walk_.rng);
        }
        lights::ImperfectVisibility visibility(own, receivers_, *maps_.imperfect);
        const lights::TileLight light = selector_->gather(own, receivers_, range, visibility, walk_.rng);
        imperfect_lookups_ += visibility.lookups();
        return light;
    }

    /// gather() at the scattering points, the n-th of every lane at once. VPLs are shared out among a few of
    /// them.
    void gather_at_points(const lights::VplRange& range, float vpl_scale) {
        if (std::all_of(points_.begin(), points_.end(), [](const auto& points) { return points.empty(); }))
            return;
        const auto count = std::size_t(settings_.scattering_points);
        const std::size_t receivers = selector_->records() ? count : std::min(count, max_receivers);
        const std::size_t spacing = count / receivers;
        for (std::size_t n = 0; n < count; ++n) {
            const bool receives = n % spacing == 0 && n / spacing < receivers;
            receivers_.clear();
            for (int i = 0; i < lights::ReceiverTile::width; ++i)
                if (const auto& points = points_[std::size_t(i)]; !points.empty())
                    at_point(i, points[n], receives ? float(count) / float(receivers) : 0.0f);
            if (receives)
                gather(selector_->takes_ranges() ? lights::VplRange{range.first + n / spacing * range.stride,
                                                                    range.stride * receivers, range.end}
                                                 : range,
                       selector_->takes_ranges() ? vpl_scale * float(receivers) : vpl_scale);
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
        const float stays = core::max_component(path.throughput()) / rare_light;
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
                lane.path->light_at(vertex, point.weight, state, walk_, {false, maps_.lights});
        if (share > 0.0f && settings_.eye.wanted[Transport::multiple_scattering]) {
            if (lane.path->depth() == 1 && lane.seen.volume.shared)
                lane.seen.volume.modulation += share * point.weight;
            add_receiver(index, vertex, share * point.weight, state);
        }
        lane.rng = walk_.rng;
    }

    /// `throughput` is the weight of the eye path up to `vertex`, which stays until the gathering.
    void add_receiver(int index, const core::ScatteringVertex& vertex, const core::Rgb& throughput,
                      const core::MediumState& state) {
        if (!gathers_) return;
        const std::int32_t depth = settings_.eye.light_depth(packet_[index].path->depth());
        if (recorded_) {
            recorded_->push_back({vertex, throughput, state, depth});
            return;
        }
        kinds_[std::size_t(index)] =
            vertex.on_surface() ? lights::ReceiverKind::surface : lights::ReceiverKind::medium;
        receivers_.set(index, vertex, throughput, state, core::Rng(walk_.rng.next_u32()), depth);
        compensation_.add(index, vertex, throughput, state, depth);
    }

    /// Eye paths and scattering points that carry less than this share of the light are followed by chance:
    /// VPLs by the hundred cost the same wherever they are gathered.
    static constexpr float rare_light = 0.3f;
    /// So many of a ray's scattering points are receivers of VPLs: more take memory and compensation, and
    /// gain little, because they meet no more VPLs (docs/media.md).
    static constexpr std::size_t max_receivers = 2;

    const core::Scene& scene_;
    const VplSettings& settings_;
    Packet& packet_;
    core::WalkContext& walk_;
    std::unique_ptr<lights::GatherScratch> scratch_;
    EyeShadowMaps maps_;
    std::uint64_t imperfect_lookups_ = 0;
    std::unique_ptr<lights::TileSelector> selector_;
    TileCompensation<Media> compensation_;
    template <typename T>
    using PerLane = std::array<T, lights::ReceiverTile::width>;
    lights::ReceiverTile receivers_;
    PerLane<lights::ReceiverKind> kinds_{};
    PerLane<std::span<const core::ScatteringPoint>> points_;  ///< of the last segments
    PerLane<core::ScatteringVertex> vertices_;                ///< at one of them
    PerLane<std::array<core::Rgb, 2>> restored_{};            ///< compensation
    bool gathers_ = true;
    std::vector<lights::PathReceiver>* recorded_ = nullptr;
};

}  // namespace mote::integrators
