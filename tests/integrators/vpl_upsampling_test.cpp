// mote_vpl with VPLs at a lattice of the pixels: between them light comes from neighbours that see the same,
// and the pixels that find none gather their own.
#include "core/render/pass_runner.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string vpl(int upsampling, const std::string& more = "") {
    return fmt::format(
        R"(<integrator type="mote_vpl"><integer name="paths" value="32"/><float name="bound" value="1"/>
        <integer name="upsampling" value="{}"/>{}</integrator>)",
        upsampling, more);
}

struct Rendered {
    RenderStatistics light;
    core::Statistics counts;
};

Rendered render(const core::Scene& scene, const std::string& xml, std::uint32_t passes) {
    const auto integrator = integrator_from(xml);
    Rendered r{render_statistics(scene, *integrator, {8, passes, 3}), {}};
    core::Film film(scene.film().width, scene.film().height, integrator->layers(scene));
    core::PassRunner runner(scene, *integrator, 3, film);
    const std::atomic<bool> cancelled = false;
    REQUIRE(runner.run_pass(cancelled));
    runner.estimator().add_statistics(r.counts);
    return r;
}

double mean_of(const RenderStatistics& r, const std::string& layer) {
    const auto& channels = r.whole[r.layer(layer)];
    return (channels[0].mean + channels[1].mean + channels[2].mean) / 3.0;
}

}  // namespace

TEST_CASE("upsampled VPLs keep the light of the picture for a fraction of the rays", "[vpl][upsampling]") {
    const auto scene = scene_from(box(grey, fog("0.4", "")), 32);
    const Rendered all = render(*scene, vpl(1), 16), upsampled = render(*scene, vpl(2), 16);
    const double again = upsampled.counts.values.at("pixels_shaded_again");
    INFO(again << " of " << 32 * 32 << " pixels shaded again");
    CHECK((again > 0.0 && again < 0.35 * 32 * 32));  // silhouettes and edges of a small picture
    CHECK(double(upsampled.counts.rays.at("occlusion")) < 0.75 * double(all.counts.rays.at("occlusion")));
    for (const std::string layer : {"emission", "direct", "single_scattering"})  // nothing to do with it
        CHECK(mean_of(upsampled.light, layer) == Approx(mean_of(all.light, layer)).epsilon(0.03));
    for (const std::string layer : {"indirect_bounded", "multiple_scattering_bounded"}) {
        INFO(layer << ": " << mean_of(upsampled.light, layer) << " of " << mean_of(all.light, layer));
        CHECK(std::fabs(mean_of(upsampled.light, layer) / mean_of(all.light, layer) - 1.0) < 0.03);
    }
}

TEST_CASE("glossy surfaces upsampled nothing: all pixels gather, and light is what it was",
          "[vpl][upsampling]") {
    const auto scene = scene_from(box(glossy, ""), 16);
    const Rendered all = render(*scene, vpl(1), 2), upsampled = render(*scene, vpl(4), 2);
    CHECK(upsampled.counts.values.at("pixels_shaded_again") > 0.5 * 16 * 16);
    CHECK(mean_of(upsampled.light, "indirect_bounded") ==
          Approx(mean_of(all.light, "indirect_bounded")).epsilon(1e-5));
}

TEST_CASE("upsampling is refused where light of VPLs comes another way", "[vpl][upsampling]") {
    for (const std::string more :
         {R"(<integer name="interleaving" value="2"/>)", R"(<integer name="eye_samples" value="2"/>)",
          R"(<visibility type="shadow_map"/>)"})
        CHECK_THROWS_AS(integrator_from(vpl(2, more)), core::InputError);
}
