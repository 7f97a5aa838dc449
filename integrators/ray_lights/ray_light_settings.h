// Settings of `mote_ray_lights`.
#pragma once

#include <algorithm>
#include <optional>

#include "core/math/bounds.h"
#include "core/render/integrator.h"
#include "integrators/eye_path/light_path_limits.h"

namespace mote::integrators {

struct RayLightSettings {
    static constexpr double lights_a_path = 2.0;  ///< about
    EyePathLimits eye;                            ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 256;
    std::size_t connections = 12;  ///< connections of a segment of an eye path; 0: to all lights
    std::size_t candidates = 128;  ///< ray lights, and VPLs, that they are sampled from; 0: all
    std::optional<float> bound;    ///< b of VPLs from surface to surface [1/m^2]; nothing: automatic
    int scattering_points = 8;     ///< where an eye ray in media looks for the light of lights

    /// As that of mote_vpl, by how many light paths a receiver evaluates the lights of. Never that of fewer
    /// than 16: where the radius is that of the scene, all light would be found by eye paths.
    float bound_for(const core::Bounds3& bounds) const {
        if (bound) return *bound;
        const double seen = candidate_count() == 0
                                ? double(paths)
                                : std::min(double(paths), double(candidate_count()) / lights_a_path);
        const float radius = bounds.radius();
        return radius > 0.0f ? float(std::max(seen, 16.0)) / core::sqr(radius) : core::infinity;
    }
    std::size_t candidate_count() const { return connections == 0 ? 0 : candidates; }
    lights::LightPathSettings light_paths(const core::MemoryBudget& memory = {}) const {
        return light_path_settings(paths, eye, memory);
    }
};

/// The passes of `mote_ray_lights`: a fresh set of light paths each.
std::unique_ptr<core::Estimator> make_ray_light_estimator(const core::Scene& scene,
                                                          const core::RenderOptions& options,
                                                          const RayLightSettings& settings);

}  // namespace mote::integrators
