// Callbacks of the eye paths of `mote_ray_lights`.
//
// A path continues to its first surface that is no mirror and no glass. Media before it are lines, which
// gather ray lights and the VPLs on surfaces all along; lights themselves are looked for at a few scattering
// points of each. The surface gathers ray lights, and VPLs with a bounded geometry term. What the bound takes
// comes back exactly: the path continues, and where it finds the next surface so near that G > b, that one is
// a receiver as well, weighted by (G - b)/G, and so on.
#pragma once

#include <array>
#include <vector>

#include "integrators/eye_path/image_loop.h"
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
    using Packet = EyePacket<Media>;
    static constexpr std::size_t lane_count = lights::ReceiverTile::width;
    static_assert(std::size_t(Packet::width) == lane_count);

    RayLightTile(const core::Scene& scene, const RayLightSettings& settings, const RayLightPass& pass,
                 Packet& packet)
        : settings_(settings),
          pass_(pass),
          packet_(packet),
          walk_(packet.walk()),
          scratch_(std::make_unique<lights::GatherScratch>()),
          gather_({scene, *scratch_, walk_.rays, walk_.tracking, walk_.cancelled}, pass.set,
                  settings.candidate_count()) {}

    const lights::LineCounters& counters() const { return gather_.counters(); }

    /// Follows the eye paths to their ends.
    void run() {
        lanes_ = {};
        packet_.run([&] { step(); },
                    [&](int i, PathLane& path, const EyeSegment& segment) {
                        if (Media && !lanes_[std::size_t(i)].receives) add_lines(i, path, segment);
                    });
    }

  private:
    using PathLane = typename Packet::Lane;
    struct Lane {
        std::vector<lights::EyeLine> lines;  ///< of the last segment
        core::Vec3 normal{0.0f};             ///< shading normal of the last point that gathered
        bool receives = false;               ///< the path has come to its first receiver
        bool on_surface = true;              ///< or was the last one in a medium?
        float extinction = 0.0f;             ///< mean along the last segment in media [1/m]
        float step = 0.0f;                   ///< light that a connection carries
    };

    void step() {
        receivers_.clear();
        packet_.for_each(
            [&](int i, PathLane& path) { path.alive = continues(lanes_[std::size_t(i)], path); });
        packet_.sample_lights();
        packet_.for_each([&](int i, PathLane& path) {
            if (path.alive && path.path->vertex().connectable()) receive(i, *path.path);
        });
        gather();
        for (Lane& lane : lanes_) lane.lines.clear();
    }

    /// Single scattering of the first segments, and what is left of the weight behind. False where the path
    /// ends.
    bool continues(Lane& lane, PathLane& path) {
        const bool first = !lane.receives;
        if (Media && first && wants_points() && path.path->may_continue()) add_single_scattering(path);
        if (!path.alive) return false;
        // Mirrors and glass that come later send what no VPL represents.
        if (!path.path->vertex().connectable()) return first;
        return first || keep_residual(lane, *path.path);
    }

    void receive(int index, EyePath<Media>& path) {
        const core::ScatteringVertex& vertex = path.vertex();
        if (settings_.eye.wanted[Transport::indirect])
            receivers_.set(index, vertex, path.throughput(), path.state(), core::Rng(walk_.rng.next_u32()),
                           settings_.eye.light_depth(path.depth()));
        Lane& lane = lanes_[std::size_t(index)];
        lane.normal = vertex.hit.shading.n, lane.on_surface = vertex.on_surface();
        lane.receives = true;
        packet_[index].points.reset();
    }

    bool wants_points() const { return settings_.eye.wanted[Transport::single_scattering]; }

    /// Media on the first segment, and on those behind mirrors, are lines.
    void add_lines(int index, PathLane& path, const EyeSegment& segment) {
        Lane& lane = lanes_[std::size_t(index)];
        const std::int32_t depth = settings_.eye.light_depth(path.path->depth());
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

    void add_single_scattering(PathLane& lane) {
        for (const core::ScatteringPoint& point : lane.points->choose(rare_light)) {
            if (core::is_black(point.weight)) continue;
            const core::MediumState& state = lane.points->state_of(point);
            const core::ScatteringVertex vertex = lane.path->vertex_at(point.position, state);
            lane.sum[Transport::single_scattering] += lane.path->light_at(vertex, point.weight, state, walk_);
        }
    }

    /// At a vertex behind the first: (G - b)/G of the edge that led there. Returns whether anything is left.
    bool keep_residual(const Lane& lane, EyePath<Media>& path) {
        const float cosine = lane.on_surface ? std::fabs(glm::dot(lane.normal, path.ray().direction)) : 1.0f;
        const core::ScatteringVertex& vertex = path.vertex();
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
                if (eyes_[n].of[i]) attenuation_.rng[i] = core::Rng(packet_[int(i)].rng.next_u32());
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
        core::Rng rng(packet_[int(first)].rng.next_u32());
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
        for (std::size_t i = 0; i < lane_count; ++i) packet_[int(i)].sum[layer] += light[i];
    }

    /// Scattering points that carry less than this share of the light are evaluated by Russian roulette.
    static constexpr float rare_light = 0.3f;

    const RayLightSettings& settings_;
    const RayLightPass& pass_;
    Packet& packet_;
    core::WalkContext& walk_;
    std::unique_ptr<lights::GatherScratch> scratch_;
    lights::LineGather gather_;
    std::array<Lane, lane_count> lanes_;
    lights::ReceiverTile receivers_;
    std::vector<lights::EyeLines> eyes_;  ///< of this step
    std::vector<lights::LineCandidates> along_eyes_;
    lights::LineCandidates at_points_;
    lights::ReceiverTile attenuation_;  ///< states and generators of lines
};

}  // namespace mote::integrators
