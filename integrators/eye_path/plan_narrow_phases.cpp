#include "integrators/eye_path/plan_narrow_phases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mote::integrators {

namespace {

/// Some passes connect a pixel with thousands of lights: with this many for one that counts, a few are left.
constexpr double max_connections = 1000.0;

}  // namespace

double connections_per_scattering(double g) {
    const double width = 1.0 - g * g;
    return (1.0 + g * g) / (width * width);
}

void plan_narrow_phases(core::Plan& plan, const core::Scene& scene) {
    double narrowest = 0.0;
    for (const auto& medium : scene.media())
        if (medium->traits().scattering)
            narrowest = std::max(narrowest, std::abs(double(medium->phase().mean_cosine())));
    const double connections = connections_per_scattering(narrowest);
    if (connections <= max_connections) return;
    plan.miss(
        "most light of narrow phase functions", fmt::format("mean cosine {:.4g}", narrowest),
        fmt::format("one connection in {:.2g} carries it: few passes are too dark, and their noise does "
                    "not show it; volpath and mote_bdpt sample the phase function",
                    connections));
    plan.noise_unknown = "few connections meet the peak of its narrow phase functions";
}

}  // namespace mote::integrators
