// Virtual ray lights: the segments of light paths in media, kept as light sources (Novak et al. 2012).
//
// A segment leaves a light or a vertex with power P, and light scatters everywhere along it, so that a
// receiver x sees  P integral over u of  T(u) sigma_s(u) f_p G*(x, y(u)) V*(x, y(u)).  The segment reaches to
// the first surface, past the collision where its path continued: the distribution of that collision is T
// sigma_s itself. So a ray light is all that the volume VPLs at the end of its segment represent, and VPLs
// are left on surfaces alone.
#pragma once

#include "lights/ray_lights/medium_line.h"
#include "lights/virtual_lights/light_path.h"
#include "lights/virtual_lights/virtual_point_light.h"
#include "lights/virtual_lights/vpl_choice.h"

namespace mote::lights {

/// The part of a segment in one medium.
struct RayLight {
    MediumLine line;          ///< where light scatters
    core::Rgb power{0.0f};    ///< that arrives at the line's origin, over the number of paths [W]
    std::uint32_t depth = 1;  ///< vertices of the path after the light, with one on this line
    std::uint32_t path = 0;   ///< index of the light path
};

/// The ray lights of one set of light paths, in path order, and the VPLs that they left on surfaces.
struct RayLightSet {
    std::vector<RayLight> rays;  ///< in path order
    VplSet surface;              ///< without states: connections are traced from receivers
    /// Sums of what lights send out, about, up to each of them; the last is the total.
    std::vector<double> ray_power, surface_power;

    /// Bytes of all lists.
    std::size_t memory_bytes() const {
        return rays.size() * sizeof(RayLight) + (ray_power.size() + surface_power.size()) * sizeof(double) +
               surface.memory_bytes();
    }
};

/// Traces one set of light paths in parallel. (seed, pass, path index) determines every path; the order of
/// the lights does not depend on threads. The set's counters hold what the paths took. Throws
/// core::Cancelled.
RayLightSet trace_ray_lights(const core::LitScene& scene, const ScatteringMedia& media,
                             const LightPathSettings& settings, std::uint64_t seed, std::uint32_t pass,
                             core::SamplerKind sampler, core::CancelToken cancelled = {});

/// Samples of lights by their power, in equal steps through the prefix sum from one random start; or all
/// lights.
class PowerSampling {
  public:
    /// `power`: sums up to each light, which must outlive this; `most`: number of samples; 0: all.
    PowerSampling(std::span<const double> power, std::size_t most)
        : power_(power), all_(most == 0 || most >= power.size()), count_(all_ ? power.size() : most) {}
    /// Number of samples; 0 where no light has power.
    std::size_t count() const { return !power_.empty() && power_.back() > 0.0 ? count_ : 0; }
    /// The n-th of count(), by a random start in [0, 1) that all of a receiver share. Its weight is one over
    /// its expected number of samples.
    WeightedVpl choose(std::size_t n, float start) const;
    /// All samples, for gathering many receivers at once (virtual_lights/vpl_choice.h).
    void choose_all(float start, std::vector<WeightedVpl>& lights) const;

  private:
    WeightedVpl choose_behind(std::size_t n, float start, std::size_t first) const;
    std::span<const double> power_;
    bool all_;
    std::size_t count_;
};

}  // namespace mote::lights
