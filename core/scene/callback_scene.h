// Another renderer's scene from a handful of functions: the queries of algorithms (ray_queries.h,
// lit_scene.h), answered by callbacks of the renderer that has the scene.
//
// The least is one function, the first hit. What is left empty follows from the others or is absent. One
// medium may fill space; renderers with boundaries between media implement RayQueries themselves. Functions
// are called from many threads at once.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/math/distribution.h"
#include "core/scene/lit_scene.h"

namespace mote::core {

/// A surface of another renderer: it has a BSDF, and no geometry that mote would query. Hits point to it,
/// so it must outlive whatever is made of them.
class ForeignSurface final : public Shape {
  public:
    /// `surface_bsdf` is not null.
    explicit ForeignSurface(std::shared_ptr<Bsdf> surface_bsdf) { bsdf = std::move(surface_bsdf); }
    /// Hit of a ray at the distance t [m]; `geometric_normal` is unit, out of the solid that the surface
    /// bounds (in a room: into the room, for diffuse walls that are seen from there). `error`: how far
    /// along it the point may lie off the surface [m]; rays that leave start so much farther out.
    SurfaceHit hit(const Ray& ray, float t, const Vec3& geometric_normal, float error = 0.0f) const;

    /// No extent, as all that follows: a foreign surface is never sampled from.
    Bounds3 bounds() const override { return {}; }
    float area() const override { return 0.0f; }                              ///< zero
    ShapeSample sample_area(const Vec2& /*u*/) const override { return {}; }  ///< of no use
    bool closed() const override { return false; }                            ///< false
    std::size_t primitive_count() const override { return 0; }                ///< zero
};

/// The functions, and the data that algorithms need besides. Rays are segments: only t in (t_min, t_max)
/// counts.
struct SceneCallbacks {
    /// The closest surface, with its `shape` and the shape's BSDF; nothing where the ray meets none. Empty:
    /// the scene has no surfaces at all, and must have a medium.
    std::function<std::optional<SurfaceHit>(const Ray&)> first_hit = {};
    /// True if there is no surface. Empty: by first_hit.
    std::function<bool(const Ray&)> visible = {};
    /// Sixteen segments at a time: sets t_max to -infinity where a surface is in the way. Lanes
    /// with t_max < t_min are idle. Empty: visible() for each lane.
    std::function<void(std::span<ShadowPacket>)> find_occluded = {};
    /// The transmittance between two points per channel, or an estimate of it without bias; surfaces are not
    /// tested. Empty: that of `medium`, 1 without.
    std::function<Rgb(const Vec3& from, const Vec3& to)> transmittance = {};
    /// Fills all of space within its own bounds; null: vacuum. Its emission is not among the lights unless
    /// its emitter is one of them.
    std::shared_ptr<Medium> medium = {};
    /// All lights; light paths start at them. May be empty for algorithms that use none.
    std::vector<std::shared_ptr<Emitter>> emitters = {};
    /// Holds everything with a surface and all lights that have a position [m].
    Bounds3 bounds = {};
};

/// The scene that the callbacks describe. Lights are chosen by their power.
class CallbackScene final : public LitScene {
  public:
    /// Throws InputError when the bounds are empty, when there is neither first_hit nor a medium, or when a
    /// light's power is negative or not finite.
    explicit CallbackScene(SceneCallbacks callbacks);

    /// Throws InputError when the host's hit has no surface or is not finite.
    std::optional<SurfaceHit> first_hit(const Ray& ray) const override;
    bool visible(const Ray& segment) const override;
    void find_occluded(std::span<ShadowPacket> packets) const override;
    bool attenuates() const override { return calls_.medium || calls_.transmittance; }
    Rgb transmittance(const Vec3& from, const Vec3& to, const MediumState& state, Rng& rng,
                      TrackingCounters& counters) const override;
    const Medium* connect(const Ray& ray, const MediumState& state, PathWeights& weights, Rng& rng,
                          TrackingCounters& counters) const override;
    bool has_boundaries() const override { return false; }  ///< false
    void boundaries_along(const Ray& /*ray*/, std::vector<SurfaceHit>& hits) const override { hits.clear(); }
    std::span<const std::shared_ptr<Medium>> media() const override {
        return {&calls_.medium, calls_.medium ? std::size_t(1) : 0};
    }
    Bounds3 medium_extent(const Medium& medium) const override;
    Bounds3 bounds() const override { return calls_.bounds; }

    /// SceneCallbacks::emitters.
    std::span<const std::shared_ptr<Emitter>> emitters() const override { return calls_.emitters; }
    const Emitter* environment() const override { return environment_; }
    LightChoice choose_light(const LightReceiver& receiver, float u) const override;
    float light_probability(const LightReceiver& receiver, const Emitter* emitter) const override;
    LightChoice choose_emitter_by_power(float u, float* remapped = nullptr) const override;
    float probability_by_power(const Emitter* emitter) const override;
    MediumState emitter_medium_state(const Emitter& emitter, const EmissionSample& sample) const override;

    /// The media at any point, where the walks and maps of mote begin.
    MediumState medium_state() const;

  private:
    SceneCallbacks calls_;
    const Emitter* environment_ = nullptr;
    Distribution1D by_power_;
};

}  // namespace mote::core
