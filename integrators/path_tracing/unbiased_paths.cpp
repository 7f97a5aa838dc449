#include "integrators/path_tracing/unbiased_paths.h"

#include <algorithm>

#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

bool lamps_in_media(const Scene& scene) {
    const auto lights = positional_lights(scene);
    return std::any_of(lights.begin(), lights.end(), [&](const Emitter* light) {
        const Medium* medium = scene.emitter_medium_state(*light, {}).current();
        return medium && medium->traits().scattering;
    });
}

std::shared_ptr<const Integrator> unbiased_paths(const Scene& scene, EyePathLimits limits) {
    limits.max_scatterings = EyePathLimits().max_scatterings;
    if (!scene.has_media()) return make_path(limits);
    return make_volpath(limits, lamps_in_media(scene));
}

void plan_control(Plan& plan, const Scene& scene, const Requirements& requirements,
                  const EyePathLimits& limits) {
    if (plan.halves_show_error()) return;
    const std::shared_ptr<const Integrator> paths = unbiased_paths(scene, limits);
    const Plan own = paths->plan(scene, requirements);
    if (!own.halves_show_error()) {
        plan.error_unknown =
            paths->type() + ", with which the image would be compared: " + own.no_halves_because();
        return;
    }
    plan.control_shows_error = true;
    if (scene.film().interval)
        plan.run("error", paths->type() + " at one pixel of eight",
                 "unbiased control passes, with which the image is compared: " + plan.no_halves_because());
}

}  // namespace mote::integrators
