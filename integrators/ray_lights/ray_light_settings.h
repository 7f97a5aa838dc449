// What a scene file sets for `mote_ray_lights`.
#pragma once

#include <algorithm>
#include <optional>

#include "core/math/bounds.h"
#include "integrators/eye_path/eye_path_limits.h"
#include "lights/virtual_lights/light_path.h"

namespace mote::integrators {

struct RayLightSettings {
    static constexpr double lights_a_path = 4.0;  ///< about
    EyePathLimits eye;                            ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 64;
    std::size_t share = 0;       ///< ray lights that a receiver looks at; 0: all
    float width = 0.0f;          ///< of beam lights [m]; 0: ray lights
    std::optional<float> bound;  ///< b of VPLs from surface to surface [1/m^2]; nothing: automatic
    int scattering_points = 4;   ///< where an eye ray in media looks for the light of lights

    /// As that of mote_vpl, by what receivers look at.
    float bound_for(const core::Bounds3& bounds) const {
        if (bound) return *bound;
        const float radius = bounds.radius();
        return radius > 0.0f ? float(looked_at()) / core::sqr(radius) : core::infinity;
    }
    /// Light paths whose lights are that many.
    double looked_at() const {
        return share == 0 ? double(paths) : std::min(double(paths), double(share) / lights_a_path);
    }
    lights::LightPathSettings light_paths() const {
        lights::LightPathSettings s;
        s.paths = paths, s.rr_depth = eye.rr_depth;
        s.max_vertices = eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - 2);
        return s;
    }
};

}  // namespace mote::integrators
