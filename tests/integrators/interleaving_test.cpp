// Interleaved virtual point lights: a pixel gathers a subset of them, which is different for its neighbours,
// and the mean is that of all lights; the filter in image space takes the noise between neighbours away.
#include "core/render/pass_runner.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string vpl(const std::string& settings, int paths = 16) {
    return fmt::format(
               R"(<integrator type="mote_vpl"><integer name="paths" value="{}"/><float name="bound" value="1"/>)",
               paths) +
           settings + "</integrator>";
}
std::string interleaved(int n) { return fmt::format(R"(<integer name="interleaving" value="{}"/>)", n); }

/// The mean picture of a layer after so many passes, filtered where the integrator does.
std::vector<core::Rgb> picture(const core::Scene& scene, const std::string& integrator,
                               const std::string& layer, int passes, core::Statistics* statistics = nullptr,
                               std::uint64_t seed = 3) {
    const auto method = integrator_from(integrator);
    core::Film film(scene.film().width, scene.film().height, method->layers(scene));
    core::PassRunner runner(scene, *method, seed, film);
    const std::atomic<bool> cancelled = false;
    for (int i = 0; i < passes; ++i) REQUIRE(runner.run_pass(cancelled));
    runner.estimator().finish(film, {});
    if (statistics) runner.estimator().add_statistics(*statistics);
    for (std::size_t i = 0; i < film.layers().size(); ++i)
        if (film.layers()[i].name == layer) return film.mean(i);
    FAIL("no layer " << layer);
    return {};
}

double squared_error(const std::vector<core::Rgb>& a, const std::vector<core::Rgb>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += core::average((a[i] - b[i]) * (a[i] - b[i]));
    return sum / double(a.size());
}
double mean_of(const std::vector<core::Rgb>& a) {
    double sum = 0.0;
    for (const core::Rgb& v : a) sum += core::average(v);
    return sum / double(a.size());
}

}  // namespace

TEST_CASE("interleaved VPLs have the mean of volpath", "[vpl][interleaving][equality]") {
    const auto scene = scene_from(box(grey, fog("0.8, 1.0, 1.3", "")), 8);
    const auto reference = render_statistics(
        *scene,
        *integrator_from(R"(<integrator type="volpath"><float name="vpl_bound" value="1"/></integrator>)"),
        {4, 3000, 2});
    for (const std::string& settings :
         {interleaved(2), interleaved(3) + R"(<integer name="eye_samples" value="2"/>)"}) {
        const auto render = render_statistics(*scene, *integrator_from(vpl(settings)), {4, 1200, 5});
        for (const std::string layer :
             {"direct", "single_scattering", "indirect_bounded", "multiple_scattering_bounded"}) {
            INFO(settings);
            check_same_mean(render, layer, reference, layer, {1.15});
        }
    }
}

TEST_CASE("interleaved VPLs and their compensation are all light",
          "[vpl][interleaving][compensation][equality]") {
    const auto scene = scene_from(box(grey, ""), 8);
    RenderSpec spec{4, 1500, 5};
    spec.sums = {{"all_indirect", {"indirect_bounded", "compensation_surface"}}};
    const auto render = render_statistics(
        *scene, *integrator_from(vpl(interleaved(2) + R"(<compensation type="exact"/>)")), spec);
    const auto reference =
        render_statistics(*scene, *integrator_from(R"(<integrator type="volpath"/>)"), {4, 3000, 2});
    check_same_mean(render, "all_indirect", reference, "indirect", {1.12});
}

TEST_CASE("a subset of the VPLs takes a fraction of the rays, with shadow maps of the lookups",
          "[vpl][interleaving]") {
    const TemporaryFolder folder;
    const auto scene = scene_from(box(grey, smoke_medium(folder.file("smoke.vol"))), 16);
    const std::string more =
        R"(<integer name="scattering_points" value="0"/><integer name="eye_samples" value="1"/>)";
    const std::string maps =
        R"(<visibility type="shadow_map"><integer name="size" value="12"/></visibility>)";
    core::Statistics all, subset, mapped, mapped_subset;
    const auto reference = picture(*scene, vpl(more + maps), "indirect_bounded", 16, &mapped);
    const auto interleaved_maps =
        picture(*scene, vpl(more + maps + interleaved(4)), "indirect_bounded", 16, &mapped_subset);
    picture(*scene, vpl(more), "indirect_bounded", 16, &all);
    picture(*scene, vpl(more + interleaved(4)), "indirect_bounded", 16, &subset);
    // Next-event estimation has a ray or less a pixel; of the rest a sixteenth is left.
    const double next_event = 256.0 * 16.0;
    CHECK(double(subset.rays["occlusion"]) < double(all.rays["occlusion"]) / 14.0 + next_event);
    CHECK(double(mapped_subset.lookups["shadow_maps"]) < double(mapped.lookups["shadow_maps"]) / 12.0);
    // Sixteen passes go through all subsets: means agree as far as noise lets them.
    CHECK(mean_of(interleaved_maps) == Approx(mean_of(reference)).epsilon(0.1));
}

TEST_CASE("the filter takes the noise of interleaving away, and leaves the mean", "[vpl][interleaving]") {
    const auto scene = scene_from(box(grey, fog("0.3", "")), 32);
    const std::string four = interleaved(4), filter = R"(<boolean name="filter" value="true"/>)";
    for (const std::string layer : {"indirect_bounded", "multiple_scattering_bounded"}) {
        const auto exact = picture(*scene, vpl("", 64), layer, 12);
        // Sums over seeds: few VPLs hold most of the error of one.
        double of_plain = 0.0, of_smooth = 0.0, bias = 0.0;
        for (std::uint64_t seed = 4; seed < 12; ++seed) {
            const auto plain = picture(*scene, vpl(four), layer, 8, nullptr, seed),
                       smooth = picture(*scene, vpl(four + filter), layer, 8, nullptr, seed);
            UNSCOPED_INFO(layer << ": " << squared_error(plain, exact) << " to "
                                << squared_error(smooth, exact));
            of_plain += squared_error(plain, exact), of_smooth += squared_error(smooth, exact);
            bias += core::sqr(mean_of(smooth) - mean_of(plain));
        }
        CHECK(of_smooth < 0.35 * of_plain);
        // Bias of smoothing, mostly missing outliers, is a small part of the remaining error.
        CHECK(bias < 0.1 * of_smooth);
    }
}
