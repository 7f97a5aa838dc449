// Emission of media. A homogeneous medium is met by walks alone, a heterogeneous one of the same coefficients
// by walks and by points sampled from it: both must light the same picture. Particles that start in them
// carry the same light.
#include <fmt/format.h>

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/grid_convergence.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

/// The box without its lamp: a small glowing cube above the floor is the only light. With `fog` around it or
/// not.
std::string glow(bool heterogeneous, bool fog) {
    const std::string room = box(grey, fog ? mote::tests::fog("0.5, 0.4, 0.3", "") : "");
    return with(without_area_light(room), glowing_cube(heterogeneous));
}

RenderStatistics render(const std::string& xml, const std::string& integrator, std::uint32_t passes,
                        std::uint64_t seed) {
    const auto scene = scene_from(xml, 8);
    return render_statistics(*scene, *integrator_from(integrator), {8, passes, seed});
}

void check(const RenderStatistics& a, const RenderStatistics& b, const std::vector<std::string>& layers,
           double planted) {
    for (const std::string& layer : layers) {
        check_same_mean(a, layer, b, layer, {planted});
    }
}

const std::string volpath = R"(<integrator type="volpath"/>)";

}  // namespace

TEST_CASE("points sampled from a glowing medium change the noise, not the mean", "[emissive][equality]") {
    for (const bool fog : {false, true}) {
        const auto sampled = render(glow(true, fog), volpath, 8000, 1);
        const auto walked = render(glow(false, fog), volpath, 20000, 2);
        INFO("fog " << fog);
        check(sampled, walked, {"emission", "direct", "indirect", "beauty"}, 1.06);
        if (fog) check(sampled, walked, {"single_scattering", "multiple_scattering"}, 1.12);
        const std::size_t direct = sampled.layer("direct");
        const double quieter = (walked.whole[direct][1].variance_of_mean * walked.passes) /
                               (sampled.whole[direct][1].variance_of_mean * sampled.passes);
        CHECK(quieter > 3.0);
    }
}

TEST_CASE("bidirectional paths meet the light of a glowing medium once", "[emissive][equality][bdpt]") {
    const auto walked = render(glow(true, true), R"(<integrator type="mote_bdpt"/>)", 2500, 1);
    const auto reference = render(glow(true, true), volpath, 5000, 2);
    check(walked, reference, {"emission", "direct", "indirect", "beauty"}, 1.1);
    check(walked, reference, {"single_scattering", "multiple_scattering"}, 1.2);
}

TEST_CASE("VPLs of a glowing medium carry what the bounded path tracer finds", "[emissive][equality]") {
    const auto reference =
        render(glow(true, true),
               R"(<integrator type="volpath"><float name="vpl_bound" value="3"/></integrator>)", 12000, 4);
    for (const bool heterogeneous : {true, false}) {
        const auto vpl = render(glow(heterogeneous, true),
                                R"(<integrator type="mote_vpl"><integer name="paths" value="24"/>
            <float name="bound" value="3"/></integrator>)",
                                2500, 3);
        INFO("heterogeneous " << heterogeneous);
        check(vpl, reference, {"indirect_bounded", "multiple_scattering_bounded"}, 1.12);
    }
}

// Kernels darken what lies along edges, in proportion to their width. Eight times the neighbours are twice
// the width in a medium and more on surfaces: three widths show how far the narrowest may be off
// (tests/support/grid_convergence.h).
TEST_CASE("Photons of a glowing medium carry its light", "[emissive][equality]") {
    const auto photons = [](int neighbours, std::uint32_t passes) {
        return render(glow(true, true),
                      fmt::format(R"(<integrator type="mote_photon_map">
            <integer name="photon_paths" value="10000"/><integer name="neighbours" value="{}"/></integrator>)",
                                  neighbours),
                      passes, 5);
    };
    const auto widest = photons(256, 10), wide = photons(32, 20), narrow = photons(4, 40);
    const auto reference = render(glow(true, true), volpath, 5000, 6);
    for (const char* layer : {"indirect", "multiple_scattering"}) {
        const auto of = [&](const RenderStatistics& r) { return r.whole[r.layer(layer)][1]; };
        const Estimate p = of(narrow), r = of(reference);
        const double edges = grid_convergence_index({of(widest).mean, of(wide).mean, p.mean}, 1.0, 2.0);
        // 1 % for both layers together.
        const double noise = 2.81 * std::sqrt(p.variance_of_mean + r.variance_of_mean);
        INFO(layer << " " << p.mean << " against " << r.mean << ", edges up to " << edges << ", noise "
                   << noise);
        CHECK(std::fabs(p.mean - r.mean) < edges + noise);
        CHECK(edges + noise < 0.16 * r.mean);  // what the comparison would see
    }
}
