// Sixteen eye paths that advance together, one segment at a time: every method that gathers at several
// receivers at once is a callback over them.
//
//   EyePacket<Media> packet(scene, settings, walk);
//   packet.start(lane, eye_ray) or packet.stop(lane), for all sixteen;
//   packet.run([&] {                        // after every step, all lanes are one segment farther
//       packet.sample_lights();             // direct light of all lanes
//       packet.for_each([&](int lane, auto& l) { if (l.alive) ... l.path->vertex() ... l.sum ... });
//   });
//
// Paths keep their own random numbers, so that the lanes do not change each other's results. All lanes take
// their next segment in next_segments(), and connect to lights in sample_lights().
#pragma once

#include <array>
#include <optional>

#include "integrators/eye_path/eye_path.h"
#include "integrators/eye_path/shared_pixels.h"

namespace mote::integrators {

/// Settings that the paths of a packet have in common.
struct EyePacketSettings {
    EyePathLimits limits;
    /// Scattering points a ray: until it has scattered, a path continues to surfaces and leaves points in the
    /// media before them (EyePath::advance_to_surface()). Nothing: distances in media are sampled.
    std::optional<int> scattering_points{};
    bool records_seen = false;               ///< Lane::seen is filled
    const core::LitScene* lights = nullptr;  ///< sampled lights, where these are not all
};

template <bool Media>
class EyePacket {
  public:
    static constexpr int side = 4, width = side * side;

    struct Lane {
        std::optional<EyePath<Media>> path;
        core::Rng rng;                                 ///< of the path, while other lanes advance
        std::optional<core::ScatteringPoints> points;  ///< of its segments; nothing: distances are sampled
        TransportSum sum;                              ///< light of the path so far
        SeenPixel seen;                                ///< first hit, where these are recorded
        core::Vec2 film{0.0f};                         ///< position of its ray in the image [pixels]
        bool advanced = false;                         ///< it took the last segment
        bool alive = false;  ///< it is at a vertex (after start(): at the camera); false ends it
    };

    EyePacket(const core::Scene& scene, const EyePacketSettings& settings, core::WalkContext& walk)
        : scene_(scene), settings_(settings), walk_(walk) {}

    void start(int lane, const EyeRay& eye) {
        Lane& l = lanes_[std::size_t(lane)];
        l.sum = {}, l.seen = {}, l.film = eye.film, l.alive = true;
        walk_.rng = eye.rng;
        l.path.emplace(scene_, settings_.limits, eye, walk_, settings_.lights);
        if (Media && settings_.scattering_points) l.points.emplace(*settings_.scattering_points);
        l.rng = walk_.rng;
    }
    /// The lane has no path.
    void stop(int lane) {
        Lane& l = lanes_[std::size_t(lane)];
        l.sum = {}, l.alive = false;
    }

    /// Advances all paths to their ends. `step()` is called after every segment, and ends paths by
    /// Lane::alive; `on_segment(index, lane, EyeSegment)` receives each segment before its vertex is made.
    template <typename Step, typename OnSegment>
    void run(const Step& step, const OnSegment& on_segment) {
        while (advance(on_segment)) step();
    }
    template <typename Step>
    void run(const Step& step) {
        run(step, [](int, const Lane&, const EyeSegment&) {});
    }

    /// Calls visit(index, lane) for the lanes that took the last segment; the walk's generator is the lane's.
    template <typename Visit>
    void for_each(const Visit& visit) {
        for (int i = 0; i < width; ++i) {
            Lane& lane = lanes_[std::size_t(i)];
            if (!lane.advanced) continue;
            walk_.rng = lane.rng;
            visit(i, lane);
            lane.rng = walk_.rng;
        }
    }
    /// Next-event estimation at all vertices that can be connected, where it is wanted.
    void sample_lights(const lights::LightSampling& how = {}) {
        for_each([&](int, Lane& lane) {
            if (!lane.alive || !lane.path->vertex().connectable() || !lane.path->wants_connection()) return;
            lane.sum[lane.path->layer_of_connection()] += lane.path->sample_light(walk_, how);
        });
    }

    Lane& operator[](int lane) { return lanes_[std::size_t(lane)]; }
    const Lane& operator[](int lane) const { return lanes_[std::size_t(lane)]; }
    core::WalkContext& walk() { return walk_; }

  private:
    /// Returns false where no path was alive.
    template <typename OnSegment>
    bool advance(const OnSegment& on_segment) {
        bool any = false;
        for (Lane& lane : lanes_) lane.advanced = lane.alive, any |= lane.alive;
        if (any) next_segments(on_segment);
        return any;
    }
    template <typename OnSegment>
    void next_segments(const OnSegment& on_segment) {
        for_each([&](int i, Lane& lane) {
            EyePath<Media>& path = *lane.path;
            lane.alive = next_segment(lane, [&](const EyeSegment& s) { on_segment(i, lane, s); });
            if (settings_.records_seen && lane.alive && path.depth() == 1) {
                lane.seen = see_first_segment(scene_, path, lane.film);
                if (!path.vertex().connectable()) lane.seen.share_nothing();
            }
        });
    }

    template <typename OnSegment>
    bool next_segment(Lane& lane, const OnSegment& on_segment) {
        if constexpr (Media)
            if (lane.points) return lane.path->advance_to_surface(walk_, lane.sum, *lane.points, on_segment);
        return lane.path->advance(walk_, lane.sum, on_segment);
    }

    const core::Scene& scene_;
    EyePacketSettings settings_;
    core::WalkContext& walk_;
    std::array<Lane, width> lanes_;
};

}  // namespace mote::integrators
