// Methods that connect light and eye warn of media that scatter into a cone which few connections meet.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/scene/requirements.h"
#include "integrators/eye_path/plan_narrow_phases.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

/// 4 pi times the integral of the squared function over the sphere, in steps of s = ln(1 + g^2 - 2 g c).
double second_moment(double g) {
    constexpr int steps = 20000;
    const double low = 2.0 * std::log1p(-g), high = 2.0 * std::log1p(g);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double distance2 = std::exp(low + (high - low) * (i + 0.5) / steps);
        const double p = (1.0 - g * g) / (4.0 * std::numbers::pi * std::pow(distance2, 1.5));
        sum += p * p * distance2 / (2.0 * g);  // dc = distance2 ds / (2 g)
    }
    return 8.0 * std::numbers::pi * std::numbers::pi * sum * (high - low) / steps;
}

bool warns(const std::string& integrator, double g) {
    const std::string phase = fmt::format(R"(<phase type="hg"><float name="g" value="{}"/></phase>)", g);
    const auto scene = scene_from(box(grey, fog("1, 1, 1", phase)), 4);
    const auto plan = integrator_from(fmt::format(R"(<integrator type="{}"/>)", integrator))
                          ->plan(*scene, core::find_requirements(*scene));
    for (const core::PlanEntry& entry : plan.missing)
        if (entry.topic == "most light of narrow phase functions") return true;
    return false;
}

}  // namespace

TEST_CASE("Connections for one within a phase function's peak are its second moment", "[narrow_phases]") {
    for (const double g : {0.1, 0.6, 0.9, 0.99, 0.999})
        CHECK(integrators::connections_per_scattering(g) == Approx(second_moment(g)).epsilon(1e-4));
    CHECK(integrators::connections_per_scattering(0.0) == 1.0);
    CHECK(integrators::connections_per_scattering(-0.9) == integrators::connections_per_scattering(0.9));
}

TEST_CASE("Methods that connect warn of narrow phase functions, those that sample them do not",
          "[narrow_phases]") {
    for (const std::string connecting : {"mote_vpl", "mote_ray_lights", "mote_photon_map"}) {
        INFO(connecting);
        CHECK(warns(connecting, 0.99));
        CHECK(warns(connecting, -0.99));
        CHECK_FALSE(warns(connecting, 0.95));
    }
    for (const std::string sampling : {"volpath", "mote_bdpt"}) {
        INFO(sampling);
        CHECK_FALSE(warns(sampling, 0.999));
    }
}
