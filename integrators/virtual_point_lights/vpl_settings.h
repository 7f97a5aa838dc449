// Settings of `mote_vpl`.
#pragma once

#include <algorithm>
#include <optional>

#include "compensation/residual.h"
#include "compensation/roughness_clamping.h"
#include "integrators/eye_path/light_path_limits.h"
#include "integrators/layer_filter/layer_filter.h"
#include "lights/selection/selection.h"
#include "lights/virtual_lights/light_source.h"
#include "lights/visibility/visibility.h"

namespace mote::integrators {

/// Value of VplSettings::bound: the geometry term is not bounded.
inline constexpr float no_bound = -1.0f;

struct VplSettings {
    /// All VPLs are gathered. Not inline: GCC 12 would warn of members that it takes for unset.
    VplSettings();

    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 256;
    std::optional<float> bound;      ///< b [1/m^2] or no_bound; nothing: automatic
    std::optional<int> eye_samples;  ///< eye paths a pixel and pass; see eye_paths()
    std::shared_ptr<const lights::Selection> selection;
    std::shared_ptr<const lights::Visibility> visibility;
    std::shared_ptr<const compensation::Residual> residual;
    compensation::RoughnessClamping clamping;
    /// Points in media where the light along an eye ray is gathered, besides the surface behind them; 0: one
    /// collision or the surface, by chance.
    int scattering_points = 8;

    int reflective_maps = 0;  ///< texels along an edge of reflective shadow maps; 0: none

    /// n: a pixel of n x n gathers every n^2-th VPL, which counts n^2 times.
    int interleaving = 1;
    /// n: VPLs are gathered at one pixel of n x n, and between by bilateral upsampling. Not with
    /// interleaving.
    int upsampling = 1;
    bool filters = false;  ///< light of VPLs is smoothed in image space after the last pass
    LayerFilterParameters filter;

    bool bounded() const { return bound != no_bound; }
    /// VPLs are shared out among the eye paths of a pixel, instead of all of them meeting every one.
    bool vpls_shared_out() const { return selection->takes_all() && residual->shares_vpls(); }
    int eye_paths() const { return eye_samples.value_or(residual->eye_samples()); }  ///< a pixel and pass

    /// b from the size of the shapes and the number of light paths: inside r = b^(-1/2) a VPL represents the
    /// light of the paths around it, and N paths spread over a scene of radius R are about R / sqrt(N) apart.
    float bound_for(const core::Bounds3& bounds) const {
        if (!bounded()) return core::infinity;
        if (bound) return *bound;
        const float radius = bounds.radius();
        return radius > 0.0f ? float(paths) / core::sqr(radius) : core::infinity;
    }
    lights::LightPathSettings light_paths(const core::MemoryBudget& memory = {}) const {
        lights::LightPathSettings s = light_path_settings(paths, eye, memory);
        s.keep_states = selection->takes_all();  // else rays begin at receivers
        return s;
    }
    std::unique_ptr<lights::LightSource> light_source(const core::LitScene& scene,
                                                      const core::MemoryBudget& memory = {}) const {
        return reflective_maps > 0
                   ? lights::reflective_light_source(scene, reflective_maps, light_paths(memory))
                   : std::make_unique<lights::LightSource>(scene, light_paths(memory));
    }
};

/// The passes of `mote_vpl`: a fresh set of light paths each, gathered at the eye path of every pixel.
std::unique_ptr<core::Estimator> make_vpl_estimator(const core::Scene& scene,
                                                    const core::RenderOptions& options,
                                                    const VplSettings& settings);
/// Its VPLs, connected as in the passes, but by shadow rays whatever the visibility is.
std::unique_ptr<core::PointLights> make_vpl_point_lights(const core::Scene& scene,
                                                         const core::RenderOptions& options,
                                                         VplSettings settings);

}  // namespace mote::integrators
