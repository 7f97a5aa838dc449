// The eye paths of a 4x4 tile of pixels of `mote_ray_lights`.
//
// A path continues to its first surface that is no mirror and no glass. Media before it are lines, which
// gather ray lights and the VPLs on surfaces all along; lights themselves are looked for at a few scattering
// points of each. The surface gathers ray lights, and VPLs with a bounded geometry term. What the bound takes
// comes back exactly: the path continues, and where it finds the next surface so near that G > b, that one is
// a receiver as well, weighed by (G - b)/G, and so on.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "integrators/eye_path/eye_path.h"
#include "integrators/ray_lights/ray_light_settings.h"
#include "lights/ray_lights/line_gather.h"

namespace mote::integrators {

/// The lights of a pass.
struct RayLightPass {
    const lights::ScatteringMedia& media;
    const lights::RayLightSet& set;
    float bound;  ///< b [1/m^2]
};

template <bool Media>
class RayLightTile {
  public:
    static constexpr int side = 4;
    static constexpr std::size_t lane_count = lights::ReceiverTile::width;
    static_assert(std::size_t(side * side) == lane_count);

    RayLightTile(const core::Scene& scene, const RayLightSettings& settings, const RayLightPass& pass,
                 lights::GatherScratch& scratch, core::WalkContext& walk)
        : scene_(scene),
          settings_(settings),
          pass_(pass),
          walk_(walk),
          context_{scene, scratch, walk.rays, walk.tracking, walk.cancelled},
          gather_(context_, pass.set, settings.candidate_count()) {}

    void start(int lane, const EyeRay& eye) {
        Lane& l = lanes_[std::size_t(lane)];
        l.sum = {}, l.alive = true, l.lines.clear();
        l.extinction = l.step = 0.0f;
        walk_.rng = eye.rng;
        l.path.emplace(scene_, settings_.eye, eye, walk_);
        l.points.emplace(wants_points() ? settings_.scattering_points : 0);
        l.rng = walk_.rng;
    }
    void stop(int lane) { lanes_[std::size_t(lane)].alive = false; }
    const TransportSum& sum(int lane) const { return lanes_[std::size_t(lane)].sum; }
    const lights::LineCounters& counters() const { return gather_.counters(); }

    /// Follows the eye paths to their ends.
    void run() {
        for (bool any = true; any;) {
            receivers_.clear();
            any = false;
            for (std::size_t i = 0; i < lane_count; ++i) {
                Lane& lane = lanes_[i];
                lane.lines.clear();
                if (!lane.alive) continue;
                walk_.rng = lane.rng;
                lane.alive = advance(lane, int(i));
                lane.rng = walk_.rng;
                any |= lane.alive;
            }
            gather();
        }
    }

  private:
    struct Lane {
        std::optional<EyePath<Media>> path;
        core::Rng rng;  ///< of the path, while other lanes advance
        TransportSum sum;
        std::optional<core::ScatteringPoints> points;
        std::vector<lights::EyeLine> lines;  ///< of the last segment
        core::Vec3 normal{0.0f};             ///< shading normal of the last point that gathered
        bool on_surface = true;              ///< or was that in a medium?
        float extinction = 0.0f;             ///< mean along the last segment in media [1/m]
        float step = 0.0f;                   ///< light that a connection carries
        bool alive = false;
    };

    bool wants_points() const { return settings_.eye.wanted[Transport::single_scattering]; }
    /// Deeper lights would make a path longer than max_depth.
    std::int32_t light_depth(int eye_depth) const {
        const int most = settings_.eye.max_depth;
        return most < 0 ? std::numeric_limits<std::int32_t>::max() : std::max(0, most - eye_depth - 1);
    }

    /// Follows one eye path to its next vertex, and makes a receiver of it. Returns whether it continues.
    bool advance(Lane& lane, int index) {
        EyePath<Media>& path = *lane.path;
        const bool first = path.scatterings() == 0 && (path.depth() == 0 || !path.vertex().connectable());
        if (!(first ? to_surface(lane) : path.advance(walk_, lane.sum))) return false;
        const core::ScatteringVertex& vertex = path.vertex();
        if (first && !vertex.connectable()) return true;
        if (!first && !keep_residual(lane)) return false;
        if (path.wants_connection()) lane.sum[path.layer_of_connection()] += path.sample_light(walk_);
        if (settings_.eye.wanted[Transport::indirect])
            receivers_.set(index, vertex, path.throughput(), path.state(), core::Rng(walk_.rng.next_u32()),
                           light_depth(path.depth()));
        lane.normal = vertex.hit.shading.n, lane.on_surface = vertex.on_surface();
        return true;
    }

    /// The first segment, or one behind a mirror: media on it are lines. Returns whether there is a vertex.
    bool to_surface(Lane& lane) {
        EyePath<Media>& path = *lane.path;
        bool at_vertex;
        if constexpr (Media) {
            lane.points->start(core::Rng(walk_.rng.next_u32()));
            const auto walker = [&](core::Rgb& emitted, core::WalkContext& c) {
                return core::walk_to_surface(scene_, path.ray(), path.state(), path.weights(), emitted,
                                             *lane.points, c);
            };
            at_vertex = path.advance_by(walker, walk_, lane.sum,
                                        [&](const EyeSegment& segment) { add_lines(lane, segment); });
            if (wants_points() && path.may_go_on()) add_single_scattering(lane);
        } else {
            at_vertex = path.advance(walk_, lane.sum);
        }
        return at_vertex;
    }

    void add_lines(Lane& lane, const EyeSegment& segment) {
        const std::int32_t depth = light_depth(lane.path->depth());
        if (!settings_.eye.wanted[Transport::multiple_scattering] || depth == 0) return;
        const core::Rgb throughput = lights::throughput_of<Media>(segment.before);
        core::Rng rng(walk_.rng.next_u32());
        float depth_of_media = 0.0f;
        lights::for_each_medium_line(
            {segment.ray, segment.event.surface_distance, segment.start, walk_.boundary_hits}, pass_.media,
            rng, walk_.tracking,
            [&](const lights::MediumLine& line, const core::MediumState& state,
                const core::Rgb& transmittance) {
                lane.lines.push_back({line, throughput * transmittance, state, depth});
                depth_of_media += core::average(line.sigma_t) * line.length;
            });
        lane.extinction = depth_of_media / segment.event.surface_distance;
    }

    void add_single_scattering(Lane& lane) {
        for (const core::ScatteringPoint& point : lane.points->choose(rare_light)) {
            if (core::is_black(point.weight)) continue;
            const core::MediumState& state = lane.points->state_of(point);
            const core::ScatteringVertex vertex = lane.path->vertex_at(point.position, state);
            lane.sum[Transport::single_scattering] += lane.path->light_at(vertex, point.weight, state, walk_);
        }
    }

    /// At a vertex behind the first: (G - b)/G of the edge that led there. Returns whether anything is left;
    /// mirrors and glass send what no VPL represents.
    bool keep_residual(Lane& lane) {
        EyePath<Media>& path = *lane.path;
        const core::ScatteringVertex& vertex = path.vertex();
        if (!vertex.connectable()) return false;
        const float cosine = lane.on_surface ? std::fabs(glm::dot(lane.normal, path.ray().direction)) : 1.0f;
        const float g = cosine * vertex.geometric_cosine(vertex.wo) / core::sqr(path.segment_length());
        if (!(g > pass_.bound)) return false;
        path.scale(std::isfinite(g) ? 1.0f - pass_.bound / g : 1.0f);
        return true;
    }

    /// Lights of points and of the n-th lines of all lanes at once.
    void gather() {
        eyes_.clear();
        for (std::size_t n = 0;; ++n) {
            lights::EyeLines eyes;
            bool any = false;
            for (std::size_t i = 0; i < lane_count; ++i)
                if (n < lanes_[i].lines.size()) eyes.of[i] = &lanes_[i].lines[n], any = true;
            if (!any) break;
            eyes_.push_back(eyes);
        }
        if (eyes_.empty() && !receivers_.any_active) return;
        if (!sample_candidates()) return;
        const lights::PointReceivers points(receivers_, around(), pass_.bound);
        core::Lanes expected = evaluate_all(points);
        const core::Lanes steps = steps_of(expected);
        if (receivers_.any_active)
            add(gather_.to_points(at_points_, steps, pass_.bound, receivers_), Transport::indirect);
        for (std::size_t n = 0; n < eyes_.size(); ++n) {
            for (std::size_t i = 0; i < lane_count; ++i)
                if (eyes_[n].of[i]) attenuation_.rng[i] = core::Rng(lanes_[i].rng.next_u32());
            add(gather_.to_eyes(eyes_[n], along_eyes_[n], steps, attenuation_),
                Transport::multiple_scattering);
        }
    }

    /// By the first lane that gathers. Returns whether any does.
    bool sample_candidates() {
        const auto gathers = [&](std::size_t i) {
            return !lanes_[i].lines.empty() || receivers_.max_vpl_depth[i] != 0;
        };
        std::size_t first = lane_count;
        int count = 0;
        for (std::size_t i = lane_count; i-- > 0;)
            if (gathers(i)) first = i, ++count;
        if (count == 0) return false;
        core::Rng rng(lanes_[first].rng.next_u32());
        gather_.sample_candidates(rng, count);
        return true;
    }

    core::Lanes around() const {
        core::Lanes extinction;
        for (std::size_t i = 0; i < lane_count; ++i) extinction[i] = lanes_[i].extinction;
        return extinction;
    }

    /// Importance of all candidates for points and lines: sums by lane.
    core::Lanes evaluate_all(const lights::PointReceivers& points) {
        at_points_.clear();
        if (receivers_.any_active) gather_.evaluate(points, at_points_);
        core::Lanes sum = at_points_.total();
        while (along_eyes_.size() < eyes_.size()) along_eyes_.emplace_back();
        for (std::size_t n = 0; n < eyes_.size(); ++n) {
            along_eyes_[n].clear();
            gather_.evaluate(eyes_[n], along_eyes_[n]);
            for (std::size_t i = 0; i < lane_count; ++i) sum[i] += along_eyes_[n].total()[i];
        }
        return sum;
    }

    /// Light that a connection carries: never less than on the segments before, so that what matters less has
    /// fewer.
    core::Lanes steps_of(const core::Lanes& expected) {
        core::Lanes steps;
        if (settings_.connections == 0) return steps;
        for (std::size_t i = 0; i < lane_count; ++i)
            steps[i] = lanes_[i].step = std::max(lanes_[i].step, expected[i] / float(settings_.connections));
        return steps;
    }

    void add(const lights::TileLight& light, Transport layer) {
        for (std::size_t i = 0; i < lane_count; ++i) lanes_[i].sum[layer] += light[i];
    }

    /// Scattering points that carry less than this share of the light are evaluated by Russian roulette.
    static constexpr float rare_light = 0.3f;

    const core::Scene& scene_;
    const RayLightSettings& settings_;
    const RayLightPass& pass_;
    core::WalkContext& walk_;
    lights::GatherContext context_;
    lights::LineGather gather_;
    std::array<Lane, lane_count> lanes_;
    lights::ReceiverTile receivers_;
    std::vector<lights::EyeLines> eyes_;  ///< of this step
    std::vector<lights::LineCandidates> along_eyes_;
    lights::LineCandidates at_points_;
    lights::ReceiverTile attenuation_;  ///< states and generators of lines
};

}  // namespace mote::integrators
