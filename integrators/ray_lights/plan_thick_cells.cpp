#include "integrators/ray_lights/plan_thick_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lights/ray_lights/medium_line.h"

namespace mote::integrators {

namespace {

/// Some passes connect a pixel with thousands of lights: with this many for one that counts, a few are left.
constexpr double max_connections = 1000.0;

double extent(const core::Scene& scene, const core::Medium& medium) {
    const double length = double(glm::length(scene.medium_extent(medium).diagonal()));
    return std::isfinite(length) ? length : 0.0;
}

}  // namespace

double thickest_cell(const core::Scene& scene) {
    double depth = 0.0;
    for (const auto& medium : scene.media()) {
        const core::MediumTraits traits = medium->traits();
        if (!traits.scattering || traits.homogeneous) continue;
        const double length = extent(scene, *medium);
        const double cell = length / double(lights::count_cells(float(length), traits.voxel_size));
        depth = std::max(depth, cell * double(medium->majorant()));
    }
    return depth;
}

double thickest_glow(const core::Scene& scene) {
    double depth = 0.0;
    for (const auto& medium : scene.media())
        if (medium->traits().emissive)
            depth = std::max(depth, extent(scene, *medium) * double(medium->majorant()));
    return depth;
}

void plan_thick_cells(core::Plan& plan, const core::Scene& scene) {
    const double cell = thickest_cell(scene), glow = thickest_glow(scene);
    const double connections = std::max(cell * cell, glow);
    if (connections <= max_connections) return;
    plan.miss("most light of dense media",
              cell * cell > glow ? fmt::format("up to {:.2g} optical depths in a cell of a line", cell)
                                 : fmt::format("{:.2g} optical depths across a medium that glows", glow),
              fmt::format("one connection in {:.2g} meets where light is: few passes are too dark, and their "
                          "noise does not show it; volpath and mote_bdpt sample distances by transmittance",
                          connections));
    plan.noise_unknown = "few connections meet light within its dense media";
}

}  // namespace mote::integrators
