// mote_ray_bundles against closed forms and against path: by bundles and by sampled lights, in a room, by
// sky, over a glossy surface; the bias of texels falls with their size, the noise with the number of
// directions.
#include <fmt/format.h>

#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string bundles(const std::string& parameters = "") {
    return R"(<integrator type="mote_ray_bundles"><integer name="eye_samples" value="8"/>)" + parameters +
           "</integrator>";
}
std::string number(const std::string& name, int value) {
    return fmt::format(R"(<integer name="{}" value="{}"/>)", name, value);
}
std::string density(double texels_per_metre) {
    return fmt::format(R"(<float name="texels_per_metre" value="{}"/>)", texels_per_metre);
}
const std::string by_lights = R"(<string name="direct" value="lights"/>)";

struct Mean {
    double value, error;  ///< of all channels together, and its standard error
};
Mean mean_of(const RenderStatistics& r, const std::string& layer) {
    Mean m{0.0, 0.0};
    for (const Estimate& e : r.whole[r.layer(layer)])
        m.value += e.mean, m.error += std::sqrt(e.variance_of_mean);
    return m;
}
double together(const Mean& a, const Mean& b) { return 4.5 * std::hypot(a.error, b.error); }

RenderStatistics render(const core::Scene& scene, const std::string& integrator, std::uint32_t passes,
                        std::uint64_t seed = 1) {
    return render_statistics(scene, *integrator_from(integrator), {4, passes, seed});
}

/// A diffuse floor and wall under a lamp that only the mirror-like, rough wall between them can see: all
/// light on the floor has been on a glossy surface, or is seen from there.
std::string glossy_corner(double alpha) {
    return fmt::format(R"(<scene version="3.0.0">
        <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="90"/><translate x="-1" z="1"/></transform>
            <bsdf type="roughconductor"><string name="distribution" value="ggx"/><float name="alpha" value="{}"/>
            <rgb name="specular_reflectance" value="0.9"/></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="0.5"/><rotate y="1" angle="-90"/>
            <translate x="0.5" z="1.2"/></transform><emitter type="area"><rgb name="radiance" value="6"/></emitter></shape>
        <sensor type="orthographic"><transform name="to_world"><scale x="0.7" y="0.7"/>
            <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)",
                       alpha);
}

}  // namespace

TEST_CASE("the closed furnace, as the atlas shows it", "[ray_bundles][furnace]") {
    const auto scene = scene_from(R"(<scene version="3.0.0"><shape type="cube">
        <boolean name="flip_normals" value="true"/><bsdf type="diffuse"><rgb name="reflectance" value="0.8"/></bsdf>
        <emitter type="area"><rgb name="radiance" value="1.5"/></emitter></shape>
        <sensor type="perspective"><float name="fov" value="80"/></sensor></scene>)");
    const auto r = render(*scene, bundles(density(3) + number("directions", 128)), 24);
    check_mean_is(r, "beauty", 1.5 / (1.0 - 0.8), {1.04});  // noise of a pass: 0.5 %
    CHECK(r.non_finite == 0);
}

// Smooth light alone separates a bias from that of shadows' borders: the room is lit by a sky through its
// front.
TEST_CASE("a room under a sky is path's, layer by layer, within what texels blur", "[ray_bundles]") {
    std::string xml = box(grey, "");
    xml.insert(xml.find("<sensor"),
               R"(<emitter type="constant"><rgb name="radiance" value="1, 1.2, 1.5"/></emitter>)");
    const auto scene = scene_from(xml, 12);
    const auto path = render(*scene, R"(<integrator type="path"/>)", 1500, 3);
    for (const std::string& settings : {std::string(), by_lights}) {
        const auto at = [&](double texels) {
            return render(*scene, bundles(settings + density(texels) + number("directions", 256)), 16);
        };
        const auto coarse = at(3), fine = at(6);
        for (const std::string layer : {"emission", "direct", "indirect", "beauty"}) {
            const Mean p = mean_of(path, layer), c = mean_of(coarse, layer), f = mean_of(fine, layer);
            INFO(settings << layer << ": path " << p.value << " +- " << p.error << ", 3 texels per metre "
                          << c.value << " +- " << c.error << ", 6 per metre " << f.value << " +- "
                          << f.error);
            // Halving the texels halves the bias or better: what is left is no more than what that changed.
            const double blurred = std::fabs(f.value - c.value);
            CHECK(std::fabs(f.value - p.value) < blurred + together(f, p) + together(f, c));
            CHECK(std::fabs(f.value - p.value) < 0.02 * p.value + together(f, p));
            if (p.value > 0.0 && layer != "emission")
                CHECK_FALSE(std::fabs(1.15 * f.value - p.value) < 0.02 * p.value + together(f, p));
        }
    }
}

TEST_CASE("lights with a position are sampled at texels and pixels", "[ray_bundles]") {
    std::string xml = box(grey, "");
    xml.erase(xml.rfind("<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.25\"/>"));
    xml += R"(<emitter type="point"><point name="position" x="0.3" y="0.6" z="0.5"/></emitter>
        <sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
        <lookat origin="0, 0, 3.6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
    const auto scene = scene_from(xml, 12);
    const auto path = render(*scene, R"(<integrator type="path"/>)", 500, 3);
    const auto r = render(*scene, bundles(density(8) + number("directions", 64)), 10);
    check_same_mean(r, "direct", path, "direct");
    const Mean p = mean_of(path, "indirect"), b = mean_of(r, "indirect");
    INFO("path " << p.value << " +- " << p.error << ", bundles " << b.value << " +- " << b.error);
    CHECK(std::fabs(b.value - p.value) < 0.02 * p.value + together(b, p));
    CHECK_FALSE(std::fabs(1.1 * b.value - p.value) < 0.02 * p.value + together(b, p));
}

// Light that a rough mirror casts on the floor: found by bundles alone, with the next direction known. The
// variance of a pass falls with its directions as 1 / n or faster: the standard error of 4 n is half that of
// n at most, up to a factor of 1.6 (F quantile of two variances over 24 passes each, 1 % one-sided: 2.7).
// Eight batches of 16 directions count in neither.
TEST_CASE("glossy transfer is path's, and its noise falls with the directions", "[ray_bundles][glossy]") {
    const auto scene = scene_from(glossy_corner(0.4), 8);
    const auto path = render(*scene, R"(<integrator type="path"/>)", 3000, 3);
    const Mean p = mean_of(path, "indirect");
    const auto at = [&](int directions, double texels, const std::string& more = "") {
        return render(*scene, bundles(density(texels) + number("directions", directions) + more), 24);
    };
    const auto few = at(256, 6), many = at(1024, 6);
    const Mean f = mean_of(few, "indirect"), m = mean_of(many, "indirect");
    INFO("path " << p.value << " +- " << p.error << ", 256 directions " << f.value << " +- " << f.error
                 << ", 1024 directions " << m.value << " +- " << m.error);
    CHECK(std::fabs(m.value - p.value) < 0.02 * p.value + together(m, p));
    CHECK(std::fabs(f.value - p.value) < 0.02 * p.value + together(f, p));
    CHECK(m.error < 0.5 * 1.65 * f.error);
    CHECK_FALSE(std::fabs(1.15 * m.value - p.value) < 0.02 * p.value + together(m, p));
    const std::string off = R"(<boolean name="glossy_transfer" value="false"/>)";
    CHECK(mean_of(at(256, 6, off), "indirect").value < 0.2 * p.value);
}

TEST_CASE("what ray-bundles cannot do is in the plan, and wrong words are named", "[ray_bundles][refusal]") {
    const auto scene = scene_from(box(glossy, R"(<medium type="homogeneous" name="interior"/>)"));
    const auto missing = [&](const std::string& parameters) {
        const core::Plan plan =
            integrator_from(bundles(parameters))->plan(*scene, core::find_requirements(*scene));
        std::string topics;
        for (const auto& entry : plan.missing) topics += entry.topic + "; ";
        return topics;
    };
    CHECK(missing("") == "media; ");
    CHECK(missing(R"(<string name="transfer" value="one_bounce"/>)") ==
          "media; glossy surfaces; long paths; ");
    const auto refused = [](const std::string& parameters) -> std::string {
        try {
            integrator_from(bundles(parameters));
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "";
    };
    CHECK(refused(R"(<string name="transfer" value="one_bounc"/>)").find("did you mean 'one_bounce'") !=
          std::string::npos);
    CHECK(refused(number("directions", 8)).find("'directions' is 8 but must lie between 16 and") !=
          std::string::npos);
    CHECK(refused(R"(<float name="texels_per_metre" value="-1"/>)").find("-1 but must lie between 0 and") !=
          std::string::npos);
}

TEST_CASE("a shape that takes all texels is refused, and the plan has the number of reflections",
          "[ray_bundles][refusal]") {
    const auto planet = [](double radius) {
        std::string xml = box(grey, "");
        xml.insert(xml.find("<sensor"), fmt::format(R"(<shape type="sphere"><float name="radius" value="{0}"/>
            <point name="center" x="0" y="-{1}" z="0"/></shape>)",
                                                    radius, 2.0 * radius));
        return scene_from(xml, 4);
    };
    core::RenderRequest request;
    request.stop.passes = 1;
    const auto integrator = integrator_from(bundles(number("directions", 64)));
    CHECK_THROWS_WITH(core::render(*planet(1e11), *integrator, request),
                      ContainsSubstring("takes all texels"));
    CHECK_NOTHROW(core::render(*planet(10.0), *integrator, request));
    const auto room = scene_from(box(grey, ""), 4);
    CHECK(integrator->plan(*room, core::find_requirements(*room)).to_text().find("more than 4 reflections") !=
          std::string::npos);
}
