// Equi-angular sampling changes the noise of single scattering, never its mean.
#include "integrators/path_tracing/equiangular.h"

#include <fmt/format.h>

#include <filesystem>

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;
using mote::integrators::sample_equiangular;

namespace {

/// A point light and a spot light in the box, outside the medium: inside, light at collisions would have no
/// finite variance to test with.
std::string lit_box(const std::string& medium) {
    std::string xml = box(grey, medium);
    const auto lamp = xml.find("<emitter type=\"area\">");
    xml.erase(lamp, xml.find("</emitter>", lamp) + 10 - lamp);  // its samples would only add noise
    const std::string lights = R"(
        <emitter type="point"><point name="position" x="0.6" y="0.4" z="1.5"/>
            <rgb name="intensity" value="3, 3.5, 4"/></emitter>
        <emitter type="spot"><transform name="to_world"><lookat origin="-0.6, 0.7, 1.7" target="0, -0.4, 0"
            up="0, 0, 1"/></transform><rgb name="intensity" value="40, 30, 20"/></emitter>)";
    return xml.insert(xml.find("<sensor"), lights);
}

void check_equal(const std::string& xml) {
    const auto scene = scene_from(xml, 8);
    const auto render = [&](const char* settings, std::uint32_t passes, std::uint64_t seed) {
        return render_statistics(
            *scene, *integrator_from(fmt::format(R"(<integrator type="volpath">{}</integrator>)", settings)),
            {8, passes, seed});
    };
    const auto along = render(R"(<boolean name="equiangular" value="true"/>)", 5000, 5);
    const auto reference = render("", 10000, 6);
    for (const char* layer : {"direct", "single_scattering", "multiple_scattering", "beauty"}) {
        check_same_mean(along, layer, reference, layer, {1.1});
    }
}

}  // namespace

TEST_CASE("Equi-angular sampling keeps the mean in a homogeneous medium", "[equiangular][equality]") {
    check_equal(lit_box(fog("0.5, 1, 2", R"(<phase type="hg"><float name="g" value="0.5"/></phase>)")));
}

TEST_CASE("Equi-angular sampling keeps the mean in a heterogeneous medium", "[equiangular][equality]") {
    const auto path = std::filesystem::temp_directory_path() / "mote_equiangular.vol";
    check_equal(lit_box(smoke_medium(path.string())));
    std::filesystem::remove(path);
}

TEST_CASE("Equi-angular sampling is quieter than collisions in thin fog", "[equiangular]") {
    // The point light alone: no other light shares the noise.
    const auto scene = scene_from(
        R"(<scene version="3.0.0"><shape type="cube"><bsdf type="null"/><medium type="homogeneous" name="interior">
        <float name="sigma_t" value="0.05"/></medium></shape>
        <emitter type="point"><point name="position" x="0.1" y="0.1" z="0"/></emitter>
        <sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
        <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)",
        8);
    const auto noise = [&](const char* value) {
        const auto xml = fmt::format(
            R"(<integrator type="volpath"><integer name="max_depth" value="2"/><boolean name="equiangular" value="{}"/>
            </integrator>)",
            value);
        const auto r = render_statistics(*scene, *integrator_from(xml), {4, 512, 1});
        return r.whole[r.layer("single_scattering")][1].variance_of_mean;
    };
    CHECK(noise("true") < 0.05 * noise("false"));
}

TEST_CASE("An equi-angular density integrates to one", "[equiangular]") {
    // The mean of g(t) / p(t) is the integral of g: here of 1 over a finite ray, and of exp(-t) over an
    // infinite one.
    const core::Ray ray{core::Vec3(1, 2, 3), glm::normalize(core::Vec3(1, 1, -2)), 0.25f};
    for (const core::Vec3& light :
         {core::Vec3(2, 2, 2), ray.at(1.0f) + core::Vec3(0.02f, 0, 0), core::Vec3(-4, 0, 9),
          ray.at(-8.0f)}) {  // behind the ray, nearly on its line: all angles lie close to half of pi
        double length = 0.0, decay = 0.0;
        const int count = 200000;
        for (int i = 0; i < count; ++i) {
            const float u = (float(i) + 0.5f) / float(count);
            const auto finite = sample_equiangular(ray, 5.0f, light, u);
            const auto infinite = sample_equiangular(ray, core::infinity, light, u);
            REQUIRE((finite && infinite));
            REQUIRE((finite->t >= ray.t_min && finite->t <= 5.0f && infinite->t >= ray.t_min));
            length += 1.0 / finite->pdf_distance;
            decay += std::exp(-double(infinite->t)) / infinite->pdf_distance;
        }
        CHECK(length / count == Approx(4.75).epsilon(1e-3));
        CHECK(decay / count == Approx(std::exp(-0.25)).epsilon(1e-3));
    }
    CHECK_FALSE(sample_equiangular(ray, 0.25f, core::Vec3(0.0f), 0.5f));
}

TEST_CASE("Equi-angular sampling and a bound are refused together", "[equiangular]") {
    CHECK_THROWS_WITH(integrator_from(R"(<integrator type="volpath"><boolean name="equiangular" value="true"/>
        <float name="vpl_bound" value="2"/></integrator>)"),
                      ContainsSubstring("equiangular"));
}
