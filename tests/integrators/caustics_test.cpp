// Caustics that path tracers do not find: mote_bdpt against photon mapping, whose kernels go to zero.
//
// The bias of a density estimate is proportional to the area of its kernel, which is to the number k of
// photons that it holds, in every pass alike. Two renders with k and 4 k photons therefore determine the
// limit: (4 A - B) / 3.
#include <fmt/format.h>

#include <cmath>

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

RenderStatistics render(const std::string& xml, const std::string& integrator, std::uint32_t passes,
                        std::uint64_t seed) {
    return render_statistics(*scene_from(xml, 16), *integrator_from(integrator), {4, passes, seed});
}

RenderStatistics photons(const std::string& xml, int neighbours, std::uint32_t passes, std::uint64_t seed) {
    return render(
        xml,
        fmt::format(R"(<integrator type="mote_photon_map"><integer name="photon_paths" value="3000"/>
                  <integer name="neighbours" value="{}"/></integrator>)",
                    neighbours),
        passes, seed);
}

Estimate limit_of(const Estimate& narrow, const Estimate& wide) {
    return {(4.0 * narrow.mean - wide.mean) / 3.0,
            (16.0 * narrow.variance_of_mean + wide.variance_of_mean) / 9.0};
}

/// Where kernels are gone: from independent renders with k and 4 k photons.
RenderStatistics limit_of(const RenderStatistics& narrow, const RenderStatistics& wide) {
    RenderStatistics limit = narrow;
    for (std::size_t l = 0; l < limit.layers.size(); ++l) {
        for (std::size_t b = 0; b < limit.blocks[l].size(); ++b)
            limit.blocks[l][b] = limit_of(narrow.blocks[l][b], wide.blocks[l][b]);
        for (std::size_t c = 0; c < 3; ++c)
            limit.whole[l][c] = limit_of(narrow.whole[l][c], wide.whole[l][c]);
    }
    return limit;
}

double z_of(const Estimate& a, const Estimate& b) {
    return (a.mean - b.mean) / std::sqrt(a.variance_of_mean + b.variance_of_mean);
}

/// The largest |z| of the picture's mean and of the blocks that the caustic lights. Where few photons come,
/// kernels are too wide for the limit to be found.
double difference(const RenderStatistics& ours, const RenderStatistics& truth, const std::string& layer) {
    const auto &a = ours.blocks[ours.layer(layer)], &b = truth.blocks[truth.layer(layer)];
    double brightest = 0.0, worst = 0.0;
    for (const Estimate& e : b) brightest = std::fmax(brightest, e.mean);
    for (std::size_t i = 1; i < b.size(); i += 3)  // green; the others are its multiples
        if (b[i].mean > 0.3 * brightest) worst = std::fmax(worst, std::fabs(z_of(a[i], b[i])));
    return std::fmax(worst,
                     std::fabs(z_of(ours.whole[ours.layer(layer)][1], truth.whole[truth.layer(layer)][1])));
}

/// Is the mean known within a third, of what it is in truth?
bool finds(const RenderStatistics& paths, const RenderStatistics& truth, const std::string& layer) {
    const Estimate e = paths.whole[paths.layer(layer)][1], t = truth.whole[truth.layer(layer)][1];
    return std::fabs(e.mean - t.mean) < t.mean / 3.0 && std::sqrt(e.variance_of_mean) < t.mean / 3.0;
}

constexpr double most = 4.5;  // standard errors

struct Passes {
    std::uint32_t ours, photons;
};

/// `other`: a ball of a glass that is nearly the same.
void check_caustic(const std::string& xml, const std::string& other, const std::string& layer,
                   Passes passes) {
    const std::string bdpt = R"(<integrator type="mote_bdpt"/>)";
    const auto ours = render(xml, bdpt, passes.ours, 1);
    const auto truth = limit_of(photons(xml, 8, passes.photons, 2), photons(xml, 32, passes.photons, 3));
    const Estimate e = ours.whole[ours.layer(layer)][1], t = truth.whole[truth.layer(layer)][1];
    INFO(fmt::format("{} +- {} against {} +- {}", e.mean, std::sqrt(e.variance_of_mean), t.mean,
                     std::sqrt(t.variance_of_mean)));
    CHECK(difference(ours, truth, layer) < most);
    CHECK(difference(ours.scaled(1.12), truth, layer) > most);
    CHECK(difference(ours.scaled(0.88), truth, layer) > most);
    CHECK(difference(render(other, bdpt, passes.ours / 2, 4), truth, layer) > most);
    CHECK(finds(ours, truth, layer));
    CHECK_FALSE(finds(render(xml, R"(<integrator type="volpath"/>)", passes.ours / 4, 5), truth, layer));
}

/// A lamp of a centimetre, facing down.
std::string lamp(double height) {
    return fmt::format(R"(<shape type="rectangle"><transform name="to_world"><scale value="0.005"/>
        <rotate y="1" angle="180"/><translate z="{}"/></transform><emitter type="area">
        <rgb name="radiance" value="10000, 8000, 6000"/></emitter></shape>)",
                       height);
}
std::string camera(const std::string& from, const std::string& to, double fov) {
    return fmt::format(R"(<sensor type="perspective"><float name="fov" value="{}"/><transform name="to_world">
        <lookat origin="{}" target="{}" up="0, 0, 1"/></transform></sensor></scene>)",
                       fov, from, to);
}
const std::string floor_below =
    R"(<shape type="rectangle"><transform name="to_world"><scale value="2"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.8"/></bsdf></shape>)";
std::string ball(double height, double radius, double ior, const std::string& more = "") {
    return fmt::format(
        R"(<shape type="sphere"><point name="center" x="0" y="0" z="{}"/><float name="radius" value="{}"/>
        <bsdf type="dielectric"><float name="int_ior" value="{}"/><float name="ext_ior" value="1"/></bsdf>{}</shape>)",
        height, radius, ior, more);
}

}  // namespace

TEST_CASE("the caustic of a glass ball is that of photons", "[bdpt][caustics]") {
    const auto scene = [](double ior) {
        return R"(<scene version="3.0.0">)" + floor_below + ball(1.5, 0.3, ior) + lamp(2.4) +
               camera("1.5, 0, 1", "0, 0, 0", 25);
    };
    check_caustic(scene(1.5), scene(1.4), "indirect", {600, 120});
}

TEST_CASE("light that stays in glass is as bright as its photons: the square of the index",
          "[bdpt][caustics]") {
    const auto scene = [](double ior) {
        return R"(<scene version="3.0.0">)" + floor_below + ball(0.3, 1.0, ior) + lamp(2.2) +
               camera("0.6, 0, 0.6", "0, 0, 0", 40);
    };
    check_caustic(scene(1.5), scene(1.4), "indirect", {400, 60});
}

TEST_CASE("the caustic of a glass ball in fog is that of photons", "[bdpt][caustics]") {
    // Dark fog: light that it scatters twice is a hundredth of what the ball focuses. It ends at a ball, for
    // photons would walk on.
    const auto scene = [](double ior) {
        const std::string medium = R"(<medium type="homogeneous" id="fog"><float name="sigma_t" value="0.3"/>
            <rgb name="albedo" value="0.05"/></medium>)";
        return R"(<scene version="3.0.0">)" + medium +
               R"(<shape type="sphere"><float name="radius" value="3"/><bsdf type="null"/>
               <ref id="fog" name="interior"/></shape>)" +
               ball(1.2, 0.5, ior, R"(<ref id="fog" name="exterior"/>)") + lamp(2.2) +
               camera("1.5, 0, 0.4", "0, 0, 0.4", 25);
    };
    check_caustic(scene(1.5), scene(1.3), "multiple_scattering", {800, 60});
}
