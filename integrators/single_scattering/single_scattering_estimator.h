// Passes of `mote_single_scattering` and `mote_epipolar`: light scattered at most once.
//
// Eye paths run at full rate (single_scattering_eye.h). Light of point-like lights scattered along the first
// rays is marched for every pixel, on a regular grid, or on epipolar lines; the last two interpolate, and
// march the pixels that nothing around them continues. Every pass moves lines, samples, grid, march steps,
// and the point on the lens that its rays pass, all of them together, by numbers of its own.
#pragma once

#include "core/parameters/parameter_list.h"
#include "core/render/integrator.h"
#include "integrators/single_scattering/scattering_accelerations.h"
#include "integrators/single_scattering/single_scattering_eye.h"
#include "screenspace/epipolar/epipolar_sampling.h"

namespace mote::integrators {

/// Light along a marched ray: integrals where there can be, or steps everywhere, of equal angles or lengths.
enum class AlongRay : std::uint8_t { exact, steps, uniform_steps };

enum class ScatteringSampling : std::uint8_t { full, sub_sampled, epipolar };

/// Lights whose light scatters in media: that of lights with a position is marched and nearly free of noise,
/// that of all others is sampled at one distance.
enum class ScatteringLights : std::uint8_t { all, positional, other };

struct ScatteringSettings {
    ScatteringLights lights = ScatteringLights::all;
    AlongRay in_scattering = AlongRay::exact;
    std::shared_ptr<const lights::Visibility> visibility = lights::traced_visibility();
    int rays = 32;  ///< of an eye path through mirrors and glass
    EyeSettings eye;
    screenspace::MarchSettings march;
    ScatteringSampling sampling = ScatteringSampling::full;
    double spacing = 4.0;  ///< of sub-sampling [pixels]
    int lines = 1024;      ///< epipolar lines of a light
    screenspace::LineSampling line;
    bool show_samples = false;  ///< a layer that counts the marched rays of every pixel

    /// March of a pass whose steps are moved by `offset`, in [0, 1).
    screenspace::MarchSettings march_from(float offset) const {
        screenspace::MarchSettings m = march;
        m.offset = offset;
        m.rule = in_scattering == AlongRay::uniform_steps ? screenspace::MarchRule::uniform
                                                          : screenspace::MarchRule::equiangular;
        return m;
    }
    AccelerationSettings accelerations() const {
        return {in_scattering == AlongRay::exact, visibility->light_maps()};
    }
};

std::unique_ptr<core::Estimator> make_single_scattering_estimator(const core::Scene& scene,
                                                                  const core::RenderOptions& options,
                                                                  const ScatteringSettings& settings);

/// Parameters of both integrators.
core::ParameterList<ScatteringSettings> scattering_parameters();

/// Default settings with these limits of eye paths and these lights.
ScatteringSettings scattering_settings(const EyePathLimits& limits, ScatteringLights lights);

/// In the order of single_scattering_layers(); the last two only in media.
enum class ScatteringLayer : std::uint8_t { emission, direct, single_scattering, marched_rays };

/// Cell of the light of these lights, scattered once in media.
constexpr TransportSet scattering_cell(ScatteringLights lights) {
    switch (lights) {
        case ScatteringLights::positional:
            return TransportSet::positional_scattering();
        case ScatteringLights::other:
            return TransportSet::other_scattering();
        default:
            return Transport::single_scattering;
    }
}

/// emission, direct, and where there are media single_scattering, and the marched rays when requested.
std::vector<core::Layer> single_scattering_layers(bool media, const ScatteringSettings& settings);

/// Plan entries of both integrators.
void plan_single_scattering(core::Plan& plan, const core::Scene& scene,
                            const core::Requirements& requirements, const ScatteringSettings& settings);
/// Lights that are marched: those with a position, not black.
std::vector<const core::Emitter*> positional_lights(const core::Scene& scene);
/// Refuses thousands of lights, each of which every pass would march. Throws InputError.
void require_few_lights(const core::Scene& scene, const ScatteringSettings& settings, std::size_t lights);
/// True if anything else lights the media.
bool has_other_lights(const core::Scene& scene);

}  // namespace mote::integrators
