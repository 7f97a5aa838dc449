#include "integrators/eye_path/plan_coarse_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mote::integrators {

double depth_of_marching_step(const core::Scene& scene, float voxels) {
    double depth = 0.0;
    for (const auto& medium : scene.media()) {
        const core::Vec3 size = scene.medium_extent(*medium).diagonal();
        const float step = medium->marching_step(voxels, glm::length(size));
        if (std::isfinite(step)) depth = std::max(depth, double(step) * double(medium->majorant()));
    }
    return depth;
}

void plan_coarse_voxels(core::Plan& plan, const core::Scene& scene, float voxels) {
    const double depth = depth_of_marching_step(scene, voxels);
    if (!(depth > thick_step)) return;
    plan.miss(
        "the edges of dense voxels", fmt::format("up to {:.2g} optical depths in a step", depth),
        "marching takes each step's extinction in its middle, and errs where that is not small; volpath "
        "and mote_bdpt do not march",
        fmt::format("voxels={:.2g}", double(voxels) * thick_step / depth));
}

}  // namespace mote::integrators
