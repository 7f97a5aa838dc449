// What a scene file sets for `mote_vpl_ray_bundles`.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "compensation/roughness_clamping.h"
#include "gathering/eye_bundles/eye_bundles.h"
#include "integrators/eye_path/eye_path_limits.h"
#include "integrators/layer_filter/layer_filter.h"
#include "lights/virtual_lights/light_path.h"

namespace mote::integrators {

struct VplBundleSettings {
    EyePathLimits eye;     ///< max_depth counts the whole path from light to eye
    int direct_paths = 0;  ///< of a pixel and pass, that direct light is the mean of; 0: by the other work
    std::uint32_t paths = 64;
    std::uint32_t directions = 8;  ///< of a pass
    std::uint32_t joined = 4;      ///< VPLs that are joined to a point that a bundle found
    float continuation = 0.25f;    ///< c, of paths that bundles begin
    gathering::Techniques techniques = gathering::Techniques::combined;
    std::optional<float> bound;  ///< b [1/m^2] of paths of two bounces and more; nothing: weighed
    bool sky = false;            ///< direct light of the sky by bundles
    bool own_rays = true;        ///< of glossy receivers, drawn by their BSDFs
    bool two_way = true;         ///< a direction serves both ways
    int bounces = 0;             ///< of paths along the pass's own directions, instead of joined VPLs
    bool repeats = false;        ///< such a path may take a direction again
    bool keeps_links = false;    ///< bundles are grids, that are looked up
    gathering::KeptLinkSettings links;
    compensation::RoughnessClamping clamping;
    int interleaving = 1;  ///< n: a pixel of n x n has every n^2-th VPL, and directions of its own
    bool filters = false;
    LayerFilterParameters filter;

    /// As many as make the error of a pass smallest where one path has as much of it in its direct light as
    /// in its indirect light: the root of how many times as much work the latter is. Times are those of the
    /// atrium of scenes/, of which only ratios matter: rays one by one, and in packets.
    int direct_paths_of_pass() const {
        if (direct_paths > 0) return direct_paths;
        constexpr float one_ray = 1.0f, packet_ray = 0.05f, eye_path = 3.0f * one_ray, vertices = 2.5f;
        const float vpls = float(paths) * vertices / float(interleaving * interleaving);
        const float along = has_bundles() ? float(directions) / (1.0f - continuation_of_pass()) : 0.0f;
        const float other = vpls * packet_ray + along * (2.0f * one_ray + float(joined) * packet_ray);
        return std::clamp(int(std::lround(std::sqrt(other / eye_path))), 1, 64);
    }
    /// c, where there is anything to weigh such paths against.
    float continuation_of_pass() const {
        return techniques == gathering::Techniques::combined && !bound ? continuation : 0.0f;
    }
    bool has_bundles() const { return techniques != gathering::Techniques::vpls && directions > 0; }
    lights::LightPathSettings light_paths() const {
        lights::LightPathSettings s;
        s.paths = paths, s.rr_depth = eye.rr_depth, s.keep_starts = true;
        s.max_vertices = eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - 2);
        return s;
    }
};

}  // namespace mote::integrators
