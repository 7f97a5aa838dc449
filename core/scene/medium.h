// The interface of participating media.
//
// One virtual call per ray segment; the loops over collisions live below it. Coefficients are per metre in
// world space. Spectral variation (RGB) is handled by spectral multiple importance sampling: one channel, the
// hero, drives the random decisions of a path, and PathWeights carries the ratio of every channel's pdf to
// the hero's (Wilkie et al. 2014; Miller et al. 2019; the book-keeping is that of pbrt-v4, section 14.2).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/math/bounds.h"
#include "core/math/random.h"
#include "core/scene/phase_function.h"

namespace mote::core {

/// Costs of tracking; added up per thread and reported in the statistics.
struct TrackingCounters {
    std::uint64_t lookups = 0;     ///< density lookups
    std::uint64_t collisions = 0;  ///< tentative collisions, real and null
    std::uint64_t fallbacks = 0;   ///< walks that hit the step limit and were ended
    /// Adds what another task counted.
    void add(const TrackingCounters& o) {
        lookups += o.lookups, collisions += o.collisions, fallbacks += o.fallbacks;
    }
};

/// Throughput of a path with its rescaled pdfs. The contribution of light L found along it is
///   throughput * L / average(unidirectional)                    where no other technique could find it,
///   throughput * L / average(unidirectional + light)            where light sampling could (balance
///   heuristic).
struct PathWeights {
    Rgb throughput{1.0f};      ///< weight of the light found at the end, before the division above
    Rgb unidirectional{1.0f};  ///< pdf_c / pdf_hero of the path as sampled, per channel c
    Rgb light{0.0f};    ///< by all light samples of the last vertex instead, over pdf_hero; black where none
    int hero = 0;       ///< the channel that drives distance sampling: 0, 1 or 2
    Vec3 vertex{0.0f};  ///< where the path scattered last, and light sampling would start from
};

/// At a point.
struct MediumCoefficients {
    Rgb sigma_t{0.0f};   ///< extinction [1/m]
    Rgb sigma_s{0.0f};   ///< scattering [1/m]
    Rgb emission{0.0f};  ///< sigma_a * L_e [W/(m^3 sr)]
};

/// Properties of a medium that choose the code that renders it.
struct MediumTraits {
    bool homogeneous = false;     ///< constant in space
    bool emissive = false;        ///< glows
    bool isotropic = true;        ///< phase function
    bool chromatic = false;       ///< extinction differs between channels
    bool scattering = true;       ///< false: sigma_s is zero everywhere
    bool empty = false;           ///< vacuum: no extinction anywhere
    float voxel_size = infinity;  ///< coefficients vary over lengths of this size [m]; infinity: nowhere
    std::string estimator = "analytic", estimator_reason = "homogeneous";  ///< of transmittance()
    std::string description;  ///< for plans: "homogeneous", "vdbvolume 'density' 128x96x80, 3.1 MB, majorants
                              ///< 16x12x10"
};

class Emitter;
class ScatteringPoints;

/// A volume that absorbs, scatters or emits light.
class Medium : public Object {
  public:
    /// Properties of the whole medium.
    virtual MediumTraits traits() const = 0;
    virtual const PhaseFunction& phase() const = 0;
    /// At a point of the world.
    virtual MediumCoefficients coefficients(const Vec3& p) const = 0;

    /// Upper bound of the extinction anywhere (largest channel) [1/m], and where the medium is not vacuum.
    virtual float majorant() const = 0;
    /// Vacuum outside [m].
    virtual Bounds3 bounds() const = 0;

    /// Delta tracking along the ray from t_min to t_max. Returns the distance of a real collision, with
    /// `weights` updated by everything up to and including the scattering coefficient there (so that
    /// throughput holds the single-scattering albedo), or nothing when the ray leaves at t_max. Emission met
    /// on the way is added to `emitted`, divided by average(unidirectional), or by the average of both
    /// techniques where light sampling at weights.vertex could have found it too. Exact for homogeneous
    /// media.
    /// A medium that only absorbs needs no distances: nothing is decided, the ray passes with chance 1, and
    /// throughput alone is multiplied, by the transmittance or an unbiased estimate of it.
    virtual std::optional<float> sample_collision(const Ray& ray, PathWeights& weights, Rgb& emitted,
                                                  Rng& rng, TrackingCounters& counters) const = 0;

    /// Both at once, the light that is scattered along the ray and what comes through: adds candidates to
    /// `points` (scattering_points.h) whose weights hold weights.throughput, and multiplies that by an
    /// unbiased estimate of the transmittance to t_max. Emission met on the way is added to `emitted`,
    /// divided by average(unidirectional), to which nothing else happens. Precondition: weights.light is
    /// black (no other technique finds what lies on this ray). The interface does it by sample_collision(),
    /// points.count() times.
    virtual void scatter_along(const Ray& ray, PathWeights& weights, Rgb& emitted, ScatteringPoints& points,
                               Rng& rng, TrackingCounters& counters) const;

    /// Ratio tracking of the transmittance from t_min to t_max for a connection to a light: multiplies
    /// `weights` so that throughput holds the estimate, `light` the pdf ratio of this technique, and
    /// `unidirectional` that of sample_collision() having passed the same way (1 where the medium only
    /// absorbs). Deterministic for homogeneous media.
    virtual void connect(const Ray& ray, PathWeights& weights, Rng& rng,
                         TrackingCounters& counters) const = 0;

    /// Unbiased estimate of the transmittance per channel, for connections without another technique (VPLs).
    virtual Rgb transmittance(const Ray& ray, Rng& rng, TrackingCounters& counters) const = 0;

    /// Optical depth per channel from t_min to t_max, by marching: deterministic, biased by the step, exact
    /// for homogeneous media. The segment, clipped to bounds(), is cut into equal steps of at most
    /// marching_step(); each counts with the extinction in its middle. An infinite segment of a medium
    /// without bounds counts as if the extinction of its start continued.
    virtual Vec3d optical_depth_along(const Ray& ray, float voxels, TrackingCounters& counters) const;
    /// Optical depths from t_min to the end of each of depths.size() equal parts of a finite segment.
    virtual void optical_depths_along(const Ray& ray, float voxels, std::span<Vec3d> depths,
                                      TrackingCounters& counters) const;
    /// Steps of `voxels` voxels [m]; of a medium that varies but names no voxel size, `default_steps` to a
    /// segment of `length` metres; infinity for homogeneous media, which need none.
    virtual float marching_step(float voxels, float length) const;
    static constexpr int default_steps = 256;  ///< of marching_step()

    /// Its emission within `box` as a light, to be sampled from; null where there is none. From then on
    /// sample_collision() weights the emission it meets against that light.
    virtual std::shared_ptr<Emitter> make_emitter(const Bounds3& /*box*/) { return nullptr; }
};

}  // namespace mote::core
