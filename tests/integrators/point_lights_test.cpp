// The points that a viewer lists for a pixel bring exactly the light that the pass has there: VPLs by every
// selection, and photons.
#include "core/render/pass_runner.h"
#include "core/render/render_driver.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string vpl(const std::string& more) {
    return R"(<integrator type="mote_vpl"><integer name="paths" value="64"/><float name="bound" value="2"/>)" +
           more + "</integrator>";
}

struct Case {
    const char *name, *xml;
};

const std::string haze = fog("0.8, 0.7, 0.6", "");

constexpr Case selections[] = {
    {"all", ""},
    {"interleaving", R"(<integer name="interleaving" value="2"/>)"},
    {"eye samples", R"(<integer name="eye_samples" value="3"/>)"},
    {"compensation", R"(<compensation type="approximate"/>)"},
    {"roughness clamping", R"(<boolean name="roughness_clamping" value="true"/>)"},
    {"uniform", R"(<selection type="uniform"><integer name="samples" value="7"/></selection>)"},
    {"lightcuts", R"(<selection type="lightcuts"/>)"},
    {"multidimensional", R"(<selection type="multidimensional_lightcuts"/>)"},
    {"stochastic",
     R"(<selection type="stochastic_lightcuts"><integer name="samples" value="9"/></selection>)"},
    {"light tree", R"(<selection type="light_tree"><integer name="samples" value="9"/></selection>)"},
    {"resampling", R"(<selection type="resampling"><integer name="candidates" value="40"/>
                      <integer name="samples" value="36"/></selection>)"},
    {"matrix", R"(<selection type="matrix"><integer name="columns" value="12"/></selection>)"}};

/// Sum of what brings light to a pixel.
core::Rgb sum_of(const core::PixelLight& light) {
    core::Rgb sum(0.0f);
    for (const auto& s : light.sources) sum += s.light;
    return sum;
}

bool close(const core::Rgb& a, const core::Rgb& b) {
    const float scale = std::max(core::max_component(a), core::max_component(b));
    return core::max_component(glm::abs(a - b)) <= 1e-5f * scale + 1e-12f;
}

/// Pixels whose points sum up to the layers of light that scattered more than once, and that are not black.
struct Agreement {
    int lit = 0, agree = 0, pixels = 0;
    core::Rgb residual{0.0f};
};
Agreement agreement(const core::Scene& scene, const std::string& xml) {
    constexpr std::uint64_t seed = 5;
    const auto method = integrator_from(xml);
    core::Film film(scene.film().width, scene.film().height, method->layers(scene));
    core::PassRunner runner(scene, *method, seed, film);
    const std::atomic<bool> never = false;
    REQUIRE(runner.run_pass(never));
    const core::PassImage& pass = runner.last_pass();
    const core::RenderOptions options{seed, scene.film().width, scene.film().height,
                                      core::SamplerKind::sobol};
    const auto points = method->point_lights(scene, options);
    REQUIRE(points);
    const auto filter =
        core::make_pixel_filter(scene.film().filter, scene.film().filter_radius, scene.film().filter_stddev);
    const core::PassContext context{0, *filter, never};
    const std::size_t count = points->points(context).size();
    Agreement found;
    for (int y = 0; y < options.height; y += 3)
        for (int x = y % 4; x < options.width; x += 4) {
            const core::PixelLight light = points->light_of(context, x, y);
            const auto at = std::size_t(y) * std::size_t(options.width) + std::size_t(x);
            core::Rgb expected = pass.layer(std::size_t(core::Transport::indirect))[at];
            if (scene.has_media())
                expected += pass.layer(std::size_t(core::Transport::multiple_scattering))[at];
            ++found.pixels, found.lit += !core::is_black(expected),
                found.agree += close(sum_of(light), expected);
            found.residual += light.residual;
            for (const auto& s : light.sources) CHECK(s.index < count);
        }
    return found;
}

}  // namespace

TEST_CASE("the VPLs listed for a pixel bring its light", "[point_lights]") {
    for (const std::string& medium : {std::string(), haze}) {
        const auto scene = scene_from(box(medium.empty() ? glossy : grey, medium), 18);
        for (const Case& c : selections) {
            CAPTURE(c.name, medium.empty());
            const Agreement found = agreement(*scene, vpl(c.xml));
            CHECK(found.lit > found.pixels / 2);
            CHECK(found.agree == found.pixels);
            CHECK(core::max_component(found.residual) > 0.0f);
        }
    }
}

TEST_CASE("the photons listed for a pixel bring its light", "[point_lights]") {
    for (const std::string& medium : {std::string(), haze}) {
        CAPTURE(medium.empty());
        const auto scene = scene_from(box(grey, medium), 18);
        const Agreement found = agreement(*scene, R"(<integrator type="mote_photon_map">
            <integer name="photon_paths" value="3000"/></integrator>)");
        CHECK(found.lit > found.pixels / 2);
        CHECK(found.agree == found.pixels);
    }
}
