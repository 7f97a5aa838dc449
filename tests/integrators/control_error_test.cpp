// The error of biased methods, stated by control passes of paths: it contains what the method leaves out.
#include "core/metrics/relative_error.h"
#include "core/render/render_driver.h"
#include "core/scene/requirements.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

constexpr int size = 48;
constexpr std::uint64_t seeds = 40;
constexpr std::uint32_t passes = 16;

std::vector<Rgb> reference_of(const Scene& scene) {
    RenderRequest request;
    request.seed = 1001, request.stop.passes = 4096;
    return render(scene, *integrator_from(R"(<integrator type="volpath"/>)"), request).film.beauty();
}

/// Seeds whose true error is in the interval, and those where it is above.
struct Counts {
    int contained = 0, above = 0;
};

Counts counts_of(const Scene& scene, const Integrator& method, std::shared_ptr<const Integrator> control) {
    const std::vector<Rgb> reference = reference_of(scene);
    Counts counts;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        RenderRequest request;
        request.seed = seed, request.stop.passes = passes, request.control = control;
        const RenderResult result = render(scene, method, request);
        REQUIRE(result.error);
        const double error =
            relative_error(result.film.beauty(), reference, relative_weights(reference)).error;
        if (error >= result.error->low && error <= result.error->high) ++counts.contained;
        if (error > result.error->high) ++counts.above;
    }
    return counts;
}

}  // namespace

TEST_CASE("Control passes find what the bound of virtual point lights removes", "[control][statistics]") {
    const auto scene = scene_from(box(grey, ""), size);
    const auto bounded = integrator_from(R"(<integrator type="mote_vpl"><integer name="paths" value="64"/>
        <float name="bound" value="1"/></integrator>)");
    const Counts counts = counts_of(*scene, *bounded, bounded->control(*scene));
    // 95 % of so many seeds, less three standard deviations.
    CHECK(counts.contained >= int(0.95 * double(seeds) - 3.0 * std::sqrt(0.95 * 0.05 * double(seeds))));
    // Planted: control passes with the light that the same bound leaves.
    const auto as_bounded =
        integrator_from(R"(<integrator type="volpath"><float name="vpl_bound" value="1"/></integrator>)");
    CHECK(counts_of(*scene, *bounded, as_bounded).above > int(seeds) / 2);
}

TEST_CASE("Plans say whether control passes show the error, or why not", "[control][plan]") {
    const auto plan_of = [](const Scene& scene, const std::string& integrator) {
        return integrator_from("<integrator type=\"" + integrator + "\"/>")
            ->plan(scene, find_requirements(scene));
    };
    const auto scene = scene_from(box(grey, ""), size);
    for (const char* type : {"mote_vpl", "mote_vsl", "mote_photon_map"}) {
        CAPTURE(type);
        CHECK(plan_of(*scene, type).control_shows_error);
        CHECK_FALSE(plan_of(*scene, type).halves_show_error());
        CHECK(plan_of(*scene, type).error_is_known());
        CHECK(integrator_from(std::string("<integrator type=\"") + type + "\"/>")->control(*scene));
    }
    for (const char* type : {"path", "volpath"}) {
        CAPTURE(type);
        CHECK_FALSE(plan_of(*scene, type).control_shows_error);
        CHECK(plan_of(*scene, type).halves_show_error());
    }
    CHECK_FALSE(plan_of(*scene, "mote_bdpt").error_is_known());
}
