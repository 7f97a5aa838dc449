// Queries of algorithms to a scene: the first surface on a ray, whether a segment is free, and which media
// lie along it and what they let through. Scene is one implementation; another renderer's scene can be
// another.
//
// Surfaces and boundaries are apart: a boundary separates media or is a pane, and light passes it straight.
// Calls are by ray or by batches of packets, so that the indirection does not count. All are safe from many
// threads.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/shadow_packet.h"
#include "core/geometry/shape.h"
#include "core/math/random.h"
#include "core/math/ray.h"
#include "core/scene/medium.h"
#include "core/scene/medium_state.h"

namespace mote::core {

/// A scene as algorithms see it.
class RayQueries {
  public:
    virtual ~RayQueries() = default;

    /// The closest surface within (t_min, t_max).
    virtual std::optional<SurfaceHit> first_hit(const Ray& ray) const = 0;
    /// True if there is no surface within (t_min, t_max).
    virtual bool visible(const Ray& segment) const = 0;
    /// Many packets of sixteen segments: t_max becomes -infinity where a surface is in the way.
    virtual void find_occluded(std::span<ShadowPacket> packets) const = 0;

    /// True if anything between two points that see each other may attenuate light. If not, transmittance()
    /// is 1 everywhere and need not be estimated.
    virtual bool attenuates() const = 0;
    /// The transmittance per channel from one point to another through all media and boundaries, estimated
    /// without bias; surfaces are not tested. `state` holds the media at `from`.
    virtual Rgb transmittance(const Vec3& from, const Vec3& to, const MediumState& state, Rng& rng,
                              TrackingCounters& counters) const = 0;
    /// Transmittance as a connection to a light, for multiple importance sampling (see Medium::connect).
    /// Returns the medium at ray.t_max, or null where that is vacuum or nothing came through.
    virtual const Medium* connect(const Ray& ray, const MediumState& state, PathWeights& weights, Rng& rng,
                                  TrackingCounters& counters) const = 0;

    /// True if there are surfaces that light passes straight.
    virtual bool has_boundaries() const = 0;
    /// A box that no boundary reaches into, empty where none was found: between points in it nothing need be
    /// queried.
    virtual const Bounds3& open_space() const {
        static const Bounds3 none;
        return none;
    }
    /// All boundaries within (t_min, t_max), sorted by distance. Clears `hits` first. What lies between them
    /// is found by for_each_part() (media_along.h).
    virtual void boundaries_along(const Ray& ray, std::vector<SurfaceHit>& hits) const = 0;
    /// Calls visit(hit) for all of them, nearest first, until it returns false.
    template <typename Visit>
    void for_each_boundary(const Ray& ray, const Visit& visit) const {
        visit_boundaries(
            ray,
            [](const void* v, const SurfaceHit& hit) { return bool((*static_cast<const Visit*>(v))(hit)); },
            &visit);
    }
    /// A function that is called with `visit`; false stops it.
    using BoundaryVisitor = bool (*)(const void* visit, const SurfaceHit& hit);
    /// Base of for_each_boundary(); worth overriding where it need not take memory.
    virtual void visit_boundaries(const Ray& ray, BoundaryVisitor visitor, const void* visit) const {
        std::vector<SurfaceHit> hits;
        boundaries_along(ray, hits);
        for (const SurfaceHit& hit : hits)
            if (!visitor(visit, hit)) return;
    }
    /// True if there are panes among the boundaries, which reflect a part of the light
    /// (Bsdf::straight_passage).
    virtual bool has_panes() const { return false; }
    /// True if any of them changes its colour.
    virtual bool has_coloured_panes() const { return false; }

    /// Every medium that a ray can meet.
    virtual std::span<const std::shared_ptr<Medium>> media() const = 0;
    bool has_media() const { return !media().empty(); }  ///< is there any?
    /// Where a medium can be met: inside the shapes that hold it, or anywhere when something names it as
    /// outside.
    virtual Bounds3 medium_extent(const Medium& medium) const = 0;
    /// Everything with a surface, the camera, and the lights that have a position.
    virtual Bounds3 bounds() const = 0;
};

}  // namespace mote::core
