// The eye paths of a 4x4 tile of pixels, advanced together to their connectable vertices, where all VPLs are
// gathered at once (lights/virtual_lights/vpl_gather.h).
//
// With scattering points a path continues to its first surface, and gathers there and at K points of the
// media before it (core/scene/scattering_points.h): at each of them the light of lights, and every K-th VPL,
// which counts K times. So the points of a ray cost no more VPLs than one collision does. Which point meets
// which VPLs is random, so that the sum is unbiased.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "integrators/eye_path/eye_path.h"
#include "integrators/eye_path/shared_pixels.h"
#include "integrators/virtual_point_lights/tile_compensation.h"
#include "integrators/virtual_point_lights/vpl_pixel.h"
#include "integrators/virtual_point_lights/vpl_settings.h"
#include "lights/selection/selection.h"

namespace mote::integrators {

/// Advances the lanes from one connectable vertex to the next, until every eye path has ended.
template <bool Media>
class EyeTile {
  public:
    static constexpr int side = 4;
    static_assert(side * side == lights::ReceiverTile::width);

    EyeTile(const core::Scene& scene, const VplSettings& settings, const lights::VplSet& vpls,
            const lights::VplSelector& selector, const compensation::ResidualTransport* transport,
            lights::GatherScratch& scratch, core::WalkContext& walk, const EyeShadowMaps& maps = {})
        : scene_(scene),
          settings_(settings),
          scratch_(scratch),
          walk_(walk),
          maps_(maps),
          selector_(selector.for_task()),
          compensation_(scene, settings.compensation, transport, vpls, scratch, walk) {}

    void start(int lane, const EyeRay& eye) {
        Lane& l = lanes_[std::size_t(lane)];
        l.sum = {}, l.receiver = lights::ReceiverKind::surface, l.alive = true;
        l.seen = {}, l.film = eye.film;
        walk_.rng = eye.rng;
        l.path.emplace(scene_, settings_.eye, eye, walk_);
        l.scattering.emplace(wants_points() ? settings_.scattering_points : 0);
        l.rng = walk_.rng;
    }
    void stop(int lane) {
        Lane& l = lanes_[std::size_t(lane)];
        l.sum = {}, l.alive = false;
    }
    const VplPixel& sum(int lane) const { return lanes_[std::size_t(lane)].sum; }
    /// First hit of the lane's eye path, after run().
    const SeenPixel& seen(int lane) const { return lanes_[std::size_t(lane)].seen; }
    /// From now on receivers are appended to these, and gather no VPLs.
    void record_receivers(std::vector<lights::PathReceiver>& all) { recorded_ = &all; }
    /// If false, the following lanes only record what they see; they gather no VPLs.
    void gathers(bool yes) { gathers_ = yes; }
    CompensationCost compensation_cost() const { return compensation_.cost(); }
    std::uint64_t imperfect_lookups() const { return imperfect_lookups_; }
    const lights::TileSelector& selector() const { return *selector_; }

    /// Position of the following lanes in the image, `spacing` pixels apart, and the weight of receivers
    /// that are stored count.
    void place(int column, int row, int spacing, float scale) {
        maps_.column = column, maps_.row = row, maps_.spacing = spacing, maps_.scale = scale;
    }

    /// Follows the eye paths and gathers the VPLs of `range`, whose light counts `vpl_scale` times.
    void run(const lights::VplRange& range, float vpl_scale) {
        for (bool any = true; any;) {
            receivers_.clear();
            any = false;
            for (int i = 0; i < lights::ReceiverTile::width; ++i) {
                Lane& lane = lanes_[std::size_t(i)];
                lane.points = {};
                if (lane.alive) lane.alive = advance(lane, i);
                any |= lane.alive;
            }
            gather(range, vpl_scale);
            if constexpr (Media) gather_at_points(range, vpl_scale);
        }
    }

    /// Gathers at all points since the last call, where the selector gathers the points of a pixel at once:
    /// those of several eye paths, too, whose light is a sum.
    void gather_recorded() {
        if (!selector_->records()) return;
        const lights::LightByKind light = selector_->gather_recorded(context(), walk_.rng);
        for (std::size_t i = 0; i < lanes_.size(); ++i)
            for (const bool surface : {true, false})
                lanes_[i].sum.transport[transport_layer(2, surface)] += light[surface ? 0 : 1][i];
    }

  private:
    struct Lane {
        std::optional<EyePath<Media>> path;
        core::Rng rng;  ///< of the path, while other lanes advance
        VplPixel sum;
        std::optional<core::ScatteringPoints> scattering;
        std::span<const core::ScatteringPoint> points;  ///< of the last segment
        core::ScatteringVertex vertex;                  ///< at one of them
        SeenPixel seen;
        core::Vec2 film{0.0f};
        lights::ReceiverKind receiver = lights::ReceiverKind::surface;
        bool alive = false;
    };

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
        for (int i = 0; i < lights::ReceiverTile::width; ++i) {
            Lane& lane = lanes_[std::size_t(i)];
            const bool surface = lane.receiver == lights::ReceiverKind::surface;
            lane.sum.transport[transport_layer(2, surface)] += vpl_scale * light[std::size_t(i)];
            lane.sum.compensation[std::size_t(lane.receiver)] += compensated[std::size_t(i)];
        }
    }

    lights::GatherContext context() {
        return {scene_, scratch_, walk_.rays, walk_.tracking, walk_.cancelled};
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
        if (std::all_of(lanes_.begin(), lanes_.end(), [](const Lane& lane) { return lane.points.empty(); }))
            return;
        const auto count = std::size_t(settings_.scattering_points);
        const std::size_t receivers = selector_->records() ? count : std::min(count, max_receivers);
        const std::size_t spacing = count / receivers;
        for (std::size_t n = 0; n < count; ++n) {
            const bool receives = n % spacing == 0 && n / spacing < receivers;
            receivers_.clear();
            for (int i = 0; i < lights::ReceiverTile::width; ++i)
                if (Lane& lane = lanes_[std::size_t(i)]; !lane.points.empty())
                    at_point(lane, i, lane.points[n], receives ? float(count) / float(receivers) : 0.0f);
            if (receives)
                gather(selector_->takes_ranges() ? lights::VplRange{range.first + n / spacing * range.stride,
                                                                    range.stride * receivers, range.end}
                                                 : range,
                       selector_->takes_ranges() ? vpl_scale * float(receivers) : vpl_scale);
        }
    }

    /// Follows one eye path to its next vertex; makes it a receiver where it can be connected. Returns
    /// whether there is one.
    bool advance(Lane& lane, int index) {
        walk_.rng = lane.rng;
        EyePath<Media>& path = *lane.path;
        const bool at_vertex = next_vertex(lane);
        if (at_vertex && path.depth() == 1 && !path.vertex().connectable()) lane.seen.share_nothing();
        if (at_vertex && path.vertex().connectable()) {
            if (path.wants_connection())
                lane.sum.transport[path.layer_of_connection()] +=
                    path.sample_light(walk_, {false, maps_.lights});
            // Engelhardt 2013, Eq. 10.9: tau sigma_s / p(t) of a receiver in a medium is in the throughput.
            // The print leaves out sigma_s (docs/errata.md).
            if (settings_.eye.wanted[transport_layer(2, path.vertex().on_surface())]) {
                see_receiver(lane.seen, path);
                add_receiver(lane, index, path.vertex(), path.throughput(), path.state());
            }
        }
        lane.rng = walk_.rng;
        return at_vertex;
    }

    bool next_vertex(Lane& lane) {
        EyePath<Media>& path = *lane.path;
        if constexpr (Media)
            if (settings_.scattering_points > 0) {
                const bool at_vertex = path.advance_to_surface(walk_, lane.sum.transport, *lane.scattering);
                if (at_vertex && path.depth() == 1) lane.seen = see_first_segment(scene_, path, lane.film);
                if (path.may_go_on()) lane.points = lane.scattering->choose(rare_light);
                return at_vertex && (path.scatterings() > 0 || survives(path));
            }
        const bool at_vertex = path.advance(walk_, lane.sum.transport);
        if (at_vertex && path.depth() == 1) lane.seen = see_first_segment(scene_, path, lane.film);
        return at_vertex;
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
    void at_point(Lane& lane, int index, const core::ScatteringPoint& point, float share) {
        if (core::is_black(point.weight)) return;
        walk_.rng = lane.rng;
        const core::MediumState& state = lane.scattering->state_of(point);
        lane.vertex = lane.path->vertex_at(point.position, state);
        if (settings_.eye.wanted[Transport::single_scattering])
            lane.sum.transport[Transport::single_scattering] +=
                lane.path->light_at(lane.vertex, point.weight, state, walk_, {false, maps_.lights});
        if (share > 0.0f && settings_.eye.wanted[Transport::multiple_scattering]) {
            if (lane.path->depth() == 1 && lane.seen.volume.shared)
                lane.seen.volume.modulation += share * point.weight;
            add_receiver(lane, index, lane.vertex, share * point.weight, state);
        }
        lane.rng = walk_.rng;
    }
    bool wants_points() const {
        return settings_.eye.wanted[Transport::single_scattering] ||
               settings_.eye.wanted[Transport::multiple_scattering];
    }

    /// `throughput` is the weight of the eye path up to `vertex`, which stays until the gathering.
    void add_receiver(Lane& lane, int index, const core::ScatteringVertex& vertex,
                      const core::Rgb& throughput, const core::MediumState& state) {
        if (!gathers_) return;
        const EyePath<Media>& path = *lane.path;
        const int max_depth = settings_.eye.max_depth;
        const std::int32_t vpl_depth =
            max_depth < 0 ? std::numeric_limits<std::int32_t>::max() : max_depth - path.depth() - 1;
        if (recorded_) {
            recorded_->push_back({vertex, throughput, state, vpl_depth});
            return;
        }
        lane.receiver = vertex.on_surface() ? lights::ReceiverKind::surface : lights::ReceiverKind::medium;
        receivers_.set(index, vertex, throughput, state, core::Rng(walk_.rng.next_u32()), vpl_depth);
        compensation_.add(index, vertex, throughput, state, vpl_depth);
    }

    /// Eye paths and scattering points that carry less than this share of the light are followed by chance:
    /// VPLs by the hundred cost the same wherever they are gathered.
    static constexpr float rare_light = 0.3f;
    /// So many of a ray's scattering points are receivers of VPLs: more take memory and compensation, and
    /// gain little, because they meet no more VPLs (docs/media.md).
    static constexpr std::size_t max_receivers = 2;

    const core::Scene& scene_;
    const VplSettings& settings_;
    lights::GatherScratch& scratch_;
    core::WalkContext& walk_;
    EyeShadowMaps maps_;
    std::uint64_t imperfect_lookups_ = 0;
    std::unique_ptr<lights::TileSelector> selector_;
    TileCompensation<Media> compensation_;
    std::array<Lane, lights::ReceiverTile::width> lanes_;
    lights::ReceiverTile receivers_;
    bool gathers_ = true;
    std::vector<lights::PathReceiver>* recorded_ = nullptr;
};

}  // namespace mote::integrators
