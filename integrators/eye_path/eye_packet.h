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
    bool records_seen = false;                                  ///< Lane::seen is filled
    const core::LitScene* lights = nullptr;                     ///< sampled lights, where these are not all
    const lights::ScatteringGuide& guide = lights::no_guide();  ///< of the paths
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
        : scene_(scene),
          settings_(settings),
          walk_(walk),
          chooses_(Media && settings.guide.candidates() > 0),
          candidates_(settings.guide.candidates()) {}

    void start(int lane, const EyeRay& eye) {
        Lane& l = lanes_[std::size_t(lane)];
        l.sum = {}, l.seen = {}, l.film = eye.film, l.alive = true;
        walk_.rng = eye.rng;
        l.path.emplace(scene_, settings_.limits, eye, walk_, settings_.lights, settings_.guide);
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
        for (int k = 0; k < settings_.limits.light_samples.at_most(); ++k)
            if (!sample_lights(k, how)) return;
    }

    Lane& operator[](int lane) { return lanes_[std::size_t(lane)]; }
    const Lane& operator[](int lane) const { return lanes_[std::size_t(lane)]; }
    core::WalkContext& walk() { return walk_; }

  private:
    /// Sample k of each lane that takes so many. Returns false where none does.
    bool sample_lights(int k, const lights::LightSampling& how) {
        core::ShadowPacket shadows;
        shadows.clear();
        std::array<bool, width> connected{};
        std::size_t rays = 0;
        bool any = false;
        for (int i = 0; i < width; ++i) {
            Lane& lane = lanes_[std::size_t(i)];
            lights::LightConnection& c = connections_[std::size_t(i)];
            const bool wanted = lane.advanced && lane.alive && k < lane.path->light_samples() &&
                                lane.path->vertex().connectable() && lane.path->wants_connection();
            const bool begun = wanted && lane.path->begin_light(k, c, how);
            const bool traced = begun && !c.map;
            connected[std::size_t(i)] = begun, rays += traced, any |= wanted;
            if (traced)
                shadows.set(i, c.shadow.origin, c.shadow.direction, c.shadow.t_max);
            else
                shadows.set(i, core::Vec3(0.0f), core::Vec3(0.0f), -1.0f);
        }
        walk_.rays.occlusion += rays;
        if (rays > 0) scene_.find_occluded({&shadows, 1});
        for_each([&](int i, Lane& lane) {
            const lights::LightConnection& c = connections_[std::size_t(i)];
            if (!connected[std::size_t(i)] || (!c.map && shadows.occluded(i))) return;
            lane.sum[lane.path->layer_of_connection()] += lane.path->finish_light(c, walk_, how);
        });
        return any;
    }

    /// Returns false where no path was alive.
    template <typename OnSegment>
    bool advance(const OnSegment& on_segment) {
        bool any = false;
        for (Lane& lane : lanes_) lane.advanced = lane.alive, any |= lane.alive;
        if (any) next_segments(on_segment);
        return any;
    }
    /// All paths leave their vertices, find their first surfaces together, and arrive there or before.
    template <typename OnSegment>
    void next_segments(const OnSegment& on_segment) {
        walk_.cancelled.check();
        std::array<core::HitQuery, width> rays;
        std::size_t count = 0;
        bool from_camera = true;
        for_each([&](int i, Lane& lane) {
            from_camera &= lane.path->depth() == 0;
            if (takes_points(lane)) return;
            lane.alive = lane.path->leave(walk_);
            if (lane.alive) rays[count++] = {&lane.path->ray(), &events_[std::size_t(i)].hit};
        });
        walk_.rays.closest += count;
        scene_.first_hits(std::span(rays).first(count), from_camera);
        for_each([&](int i, Lane& lane) {
            const auto seen = [&](const EyeSegment& s) { on_segment(i, lane, s); };
            if (takes_points(lane))
                lane.alive = lane.path->advance_to_surface(walk_, lane.sum, *lane.points, seen);
            else if (lane.alive && chooses_)
                lane.alive = lane.path->arrive_by_choice(event_of(i), walk_, lane.sum, candidates_, seen);
            else if (lane.alive)
                lane.alive = lane.path->arrive(event_of(i), walk_, lane.sum, seen);
            if (settings_.records_seen && lane.alive && lane.path->depth() == 1) {
                lane.seen = see_first_segment(scene_, *lane.path, lane.film);
                if (!lane.path->vertex().connectable()) lane.seen.share_nothing();
            }
        });
    }
    bool takes_points(const Lane& lane) const { return Media && lane.points; }
    /// After first_hits().
    core::WalkEvent& event_of(int lane) {
        using Kind = core::WalkEvent::Kind;
        core::WalkEvent& event = events_[std::size_t(lane)];
        event.kind = event.hit.shape ? Kind::surface : Kind::escaped;
        event.reflected = false, event.stop_chance = 1.0f, event.medium = nullptr;
        return event;
    }

    const core::Scene& scene_;
    EyePacketSettings settings_;
    core::WalkContext& walk_;
    bool chooses_;  ///< the guide chooses vertices, where a lane has no points of its own
    core::ScatteringPoints candidates_;  ///< of the segment of one lane
    std::array<Lane, width> lanes_;
    std::array<core::WalkEvent, width> events_;               ///< by lane, while they take a segment
    std::array<lights::LightConnection, width> connections_;  ///< by lane, while they look for light
};

}  // namespace mote::integrators
