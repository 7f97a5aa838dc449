// In-scattering without steps against many steps, along rays and in pictures; and shadow maps against shadow
// rays.
#include <fmt/format.h>

#include "screenspace/in_scattering/in_scattering.h"
#include "tests/screenspace/epipolar_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/grid_convergence.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;

namespace {

/// The product of so many transmittances is rounded by up to 1e-4.
constexpr int many_steps = 1 << 12;

const std::string point = R"(<emitter type="point"><point name="position" x="0.5" y="0.3" z="0"/>
    <rgb name="intensity" value="3, 2, 1"/></emitter>)";
const std::string spot = R"(<emitter type="spot"><transform name="to_world"><lookat origin="0.5, 1.3, 0"
    target="0, 0, 0.2" up="0, 0, 1"/></transform><rgb name="intensity" value="3, 2, 1"/>
    <float name="cutoff_angle" value="50"/><float name="beam_width" value="{}"/></emitter>)";

/// Fog in a box of 4 m, around it nothing; pillars throw shadows into it.
std::unique_ptr<Scene> pillars(const std::string& light, const std::string& more = "") {
    std::string shapes;
    for (int i = 0; i < 4; ++i)
        shapes += fmt::format(R"(<shape type="{}"><transform name="to_world"><scale value="0.25"/>
            <translate x="{}" y="{}" z="{}"/></transform><bsdf type="diffuse"/></shape>)",
                              i % 2 ? "sphere" : "cube", 1.1 - 0.7 * i, 0.4 * i - 0.9, 0.9 - 0.6 * i);
    return tests::scene_from(fmt::format(R"(<scene version="3.0.0">
        <shape type="cube"><transform name="to_world"><scale value="2"/></transform><bsdf type="null"/>
          <medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.2, 0.4, 2.5"/>
          <rgb name="albedo" value="0.9, 0.6, 0.3"/><phase type="hg"><float name="g" value="0.7"/></phase></medium></shape>
        {}{}{}<sensor type="perspective"><transform name="to_world"><lookat origin="0.3, 0.2, 5" target="0, 0, 0"
        up="0, 1, 0"/></transform></sensor></scene>)",
                                         shapes, light, more));
}

struct March {
    Vec3d light{0.0};
    Vec3d transmittance{0.0};
    std::uint64_t steps, clear;
};
March march(const Scene& scene, const Ray& ray, int steps, float offset, const UnoccludedSpace* clear,
            MarchRule rule = MarchRule::equiangular) {
    const InScattering in(scene, *scene.emitters()[0], {steps, rule, offset, 1.0f}, {clear, nullptr});
    MarchScratch scratch;
    const MarchedRay ray_light = in.march(ray, scene.medium_state_at(ray.origin, nullptr), scratch);
    return {Vec3d(ray_light.radiance), Vec3d(ray_light.transmittance), scratch.steps, scratch.unoccluded};
}

double difference(const Vec3d& a, const Vec3d& b) {
    double worst = 0.0;
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a[c] - b[c]) / std::max(b[c], 1e-12));
    return worst;
}

/// Largest relative difference from many steps over random rays, of those nothing shadows and of the others.
struct Worst {
    double clear = 0.0, shadowed = 0.0;
    int unoccluded_rays = 0, shadowed_rays = 0;
};
Worst compare(const Scene& scene, const Scene& exact_in) {
    Rng rng(4);
    const auto in = [&](float a, float b) { return a + (b - a) * rng.next_float(); };
    const UnoccludedSpace clear(exact_in.shapes());
    Worst worst;
    for (int i = 0; i < 80; ++i) {
        const Vec3 target(in(-1.5f, 1.5f), in(-1.5f, 1.5f), in(-1.0f, 1.0f));
        const Vec3 origin =
            i % 4 == 0 ? Vec3(in(-1.9f, 1.9f), in(-1.9f, 1.9f), in(-1.9f, 1.9f)) : Vec3(0.3f, 0.2f, 5.0f);
        Ray ray{origin, glm::normalize(target - origin)};
        const auto hit = scene.rays().closest(ray);
        ray.t_max = hit ? hit->t : 20.0f;
        const March many = march(scene, ray, many_steps, 0.5f, nullptr);
        if (!(max_component(Vec3(many.light)) > 1e-4f)) continue;
        const March exact = march(exact_in, ray, 512, 0.5f, &clear);
        CHECK(difference(exact.transmittance, many.transmittance) < 1e-4);
        const bool is_clear = exact.clear > 0;
        (is_clear ? worst.clear : worst.shadowed) =
            std::max(is_clear ? worst.clear : worst.shadowed, difference(exact.light, many.light));
        ++(is_clear ? worst.unoccluded_rays : worst.shadowed_rays);
        if (is_clear) CHECK(exact.steps == 0);
    }
    return worst;
}

}  // namespace

TEST_CASE("Integrals are many steps", "[in_scattering_exact]") {
    // The sums in single precision are good to some 1e-5. Of up to eight edges of shadows each is placed
    // within half a step of 512, where a step holds about 1/512 of the light.
    for (const std::string& light :
         {point, fmt::format(fmt::runtime(spot), 40), fmt::format(fmt::runtime(spot), 50),
          fmt::format(fmt::runtime(spot), 15)}) {
        const auto scene = pillars(light);
        const Worst worst = compare(*scene, *scene);
        INFO(light);
        CHECK(worst.unoccluded_rays > 5);
        CHECK(worst.shadowed_rays > 5);
        CHECK(worst.clear < 2e-5);
        CHECK(worst.shadowed < 8.0 * 0.5 / 512.0);
    }
}

TEST_CASE("A light that is a hundredth too bright is found out", "[in_scattering_exact]") {
    std::string brighter = point;
    brighter.replace(brighter.find("3, 2, 1"), 7, "3.03, 2, 1");
    CHECK(compare(*pillars(point), *pillars(brighter)).clear > 2e-5);
}

TEST_CASE("Integrals over all offsets of few steps are those of many", "[in_scattering_exact]") {
    const auto scene = pillars(point);
    const UnoccludedSpace clear(scene->shapes());
    int shadowed = 0;
    for (int k = 0; k < 40; ++k) {
        const Vec3 origin(0.3f, 0.2f, 5.0f), target(-1.2f + 0.06f * float(k), -0.2f, 0.3f);
        Ray ray{origin, glm::normalize(target - origin), 0.0f, 20.0f};
        if (const auto hit = scene->rays().closest(ray)) ray.t_max = hit->t;
        if (march(*scene, ray, 8, 0.5f, &clear).clear > 0) continue;
        ++shadowed;
        const March many = march(*scene, ray, many_steps, 0.5f, nullptr);
        for (const MarchRule rule : {MarchRule::equiangular, MarchRule::uniform}) {
            Vec3d mean(0.0);
            for (int i = 0; i < 64; ++i)
                mean += march(*scene, ray, 16, (float(i) + 0.5f) / 64.0f, &clear, rule).light / 64.0;
            // A step counts whole or not at all: where light changes within it, by the square of that.
            CHECK(difference(mean, many.light) < 0.03);
        }
    }
    CHECK(shadowed > 5);
}

TEST_CASE("What has no closed form is marched", "[in_scattering_exact]") {
    const std::string rim = fmt::format(fmt::runtime(spot), 5);
    const std::string textured =
        R"(<emitter type="spot"><texture type="checkerboard" name="texture"/></emitter>)";
    const std::string wide = R"(<emitter type="spot"><float name="cutoff_angle" value="100"/></emitter>)";
    for (const std::string& light : {rim, textured, wide})
        CHECK_FALSE(AnalyticLight::of(*pillars(light)->emitters()[0]));
    // A light outside of the fog: its boundary is in the triangle.
    std::string outside = point;
    outside.replace(outside.find("x=\"0.5\""), 7, "x=\"2.5\"");
    const auto scene = pillars(outside);
    const UnoccludedSpace clear(scene->shapes());
    const Ray ray{Vec3(0.3f, 1.4f, 5.0f), glm::normalize(Vec3(0.1f, 0.0f, -1.0f)), 0.0f, 20.0f};
    const March exact = march(*scene, ray, 64, 0.5f, &clear), steps = march(*scene, ray, 64, 0.5f, nullptr);
    CHECK(exact.steps == 64);
    CHECK(exact.light == steps.light);
    CHECK(steps.light.x > 0.0);
}

TEST_CASE("Rays without end are integrated", "[in_scattering_exact]") {
    const auto scene = tests::scene_from(R"(<scene version="3.0.0">
        <shape type="sphere"><point name="center" x="-3" y="0" z="0"/><bsdf type="diffuse"/></shape>
        <emitter type="point"><point name="position" x="1" y="0" z="0"/><rgb name="intensity" value="1"/></emitter>
        <sensor type="perspective"><medium type="homogeneous"><float name="sigma_t" value="0.05"/><float name="albedo" value="1"/>
        </medium></sensor></scene>)");
    const UnoccludedSpace clear(scene->shapes());
    const InScattering in(*scene, *scene->emitters()[0], {64, MarchRule::equiangular, 0.5f, 1.0f},
                          {&clear, nullptr});
    MarchScratch scratch;
    const Ray ray{Vec3(0.0f), Vec3(0, 0, 1)};
    const MarchedRay exact = in.march(ray, scene->camera_medium_state(), scratch);
    CHECK(scratch.unoccluded == 1);
    CHECK(scratch.walk.rays.occlusion == 0);
    const InScattering many(*scene, *scene->emitters()[0], {1 << 16, MarchRule::equiangular, 0.5f, 1.0f});
    CHECK(exact.radiance.x ==
          Approx(many.march(ray, scene->camera_medium_state(), scratch).radiance.x).epsilon(1e-4));
}

namespace {

std::string integrator(const std::string& type, const std::string& more) {
    return fmt::format(R"(<integrator type="{}">{}</integrator>)", type, more);
}
const std::string by_steps = R"(<string name="in_scattering" value="steps"/>)";
std::string by_map(int size) {
    return fmt::format(
        R"(<visibility type="shadow_map"><integer name="light_size" value="{}"/></visibility>)", size);
}
double mean_of(const tests::RenderStatistics& r) {
    const auto& whole = r.whole[r.layer("single_scattering")];
    return whole[0].mean + whole[1].mean + whole[2].mean;
}
double error_of(const tests::RenderStatistics& r) {
    const auto& whole = r.whole[r.layer("single_scattering")];
    return std::sqrt(whole[0].variance_of_mean) + std::sqrt(whole[1].variance_of_mean) +
           std::sqrt(whole[2].variance_of_mean);
}

}  // namespace

TEST_CASE("Pictures by integrals are pictures by many steps", "[in_scattering_exact]") {
    for (const Vec3d& light : {Vec3d(-1.2, 0.9, 1.5), Vec3d(0.8, 1.6, 0.5)}) {
        const auto scene = tests::sized(tests::block_in_fog(light), 64, 48);
        const std::string many = R"(<integer name="steps" value="1024"/>)";
        const auto expected = tests::render(*scene, integrator("mote_single_scattering", many + by_steps));
        const auto exact = tests::render(*scene, integrator("mote_single_scattering", ""));
        const auto steps = tests::render(*scene, integrator("mote_single_scattering", by_steps));
        const auto lines = tests::render(*scene, tests::epipolar(256, 32, tests::tolerance(0.01)));
        // An edge of a shadow is off by half a step of 64 at most, where the next pixel is as often off the
        // other way. Lines add their tolerance.
        const double half_a_step = 0.5 / 64.0;
        CHECK(tests::relative_error(exact, expected) < half_a_step);
        CHECK(tests::relative_error(exact, expected) < tests::relative_error(steps, expected));
        CHECK(tests::relative_error(lines, expected) < half_a_step + 0.01);
        CHECK(std::abs(exact.mean() / expected.mean() - 1.0) < 0.003);
        CHECK(exact.statistics.values.at("unoccluded_rays") >
              0.3 * exact.statistics.values.at("marched_rays"));
        CHECK(steps.statistics.values.at("unoccluded_rays") == 0.0);
        CHECK(lines.statistics.values.at("unoccluded_rays") > 0.0);
    }
}

TEST_CASE("Shadow maps of the lights leave marched light as it is", "[in_scattering_exact][shadow_map]") {
    const tests::TemporaryFolder folder;
    const std::string lights[] = {
        R"(<emitter type="point"><point name="position" x="0.4" y="0.5" z="1.6"/></emitter>)",
        R"(<emitter type="spot"><rgb name="intensity" value="6"/><float name="cutoff_angle" value="35"/>
            <transform name="to_world"><lookat origin="0.2, 1, 3.5" target="0, -0.5, 0" up="0, 1, 0"/></transform></emitter>)"};
    for (const std::string& medium :
         {tests::smoke_medium(folder.file("smoke.vol")), tests::fog("0.8, 1.0, 1.3", "")})
        for (const std::string& light : lights) {
            std::string xml = tests::box(tests::mixed, medium);
            const auto lamp = xml.find("<emitter type=\"area\">");
            xml.erase(lamp, xml.find("</emitter>") + 10 - lamp);
            const auto scene = tests::scene_from(xml.insert(xml.find("<sensor"), light), 16);
            const auto of = [&](const std::string& more) {
                const auto made =
                    tests::integrator_from(integrator("mote_single_scattering", by_steps + more));
                return tests::render_statistics(*scene, *made, {4, 12, 5});
            };
            const auto traced = of(""), coarse = of(by_map(6)), fine = of(by_map(192));
            // Tolerance: the error of a map of this size (docs/methods/media.md: 0.9 % at random points), and
            // noise; passes have the same offsets, so most of it is common.
            const double allowed = 0.01 * mean_of(traced) + 2.0 * (error_of(traced) + error_of(fine));
            INFO(light << medium);
            CHECK(std::abs(mean_of(fine) - mean_of(traced)) < allowed);
            CHECK(std::abs(mean_of(fine.scaled(1.04)) - mean_of(traced)) > allowed);
            CHECK(std::abs(mean_of(coarse) - mean_of(traced)) > std::abs(mean_of(fine) - mean_of(traced)));
        }
}

TEST_CASE("Marching by shadow maps traces no shadow rays", "[in_scattering_exact][shadow_map]") {
    const auto named = [](std::string xml) {  // the light names the fog, as the camera does
        return xml.insert(xml.find("</emitter>"), R"(<ref id="fog"/>)");
    };
    const std::string xml = tests::block_in_fog({0.8, 0.6, -1.0});
    const auto map = integrator("mote_single_scattering", by_steps + by_map(64));
    const auto traced = integrator("mote_single_scattering", by_steps);
    const auto scene = tests::sized(named(xml), 32, 24), unnamed = tests::sized(xml, 32, 24);
    const auto a = tests::render(*scene, map), b = tests::render(*scene, traced);
    CHECK(a.statistics.values.at("shadow_maps") == 1.0);
    CHECK(a.statistics.rays.at("occlusion") < b.statistics.rays.at("occlusion") / 10);
    // Both march at the same places, so what differs are the edges of shadows: an error of the first order in
    // the size of texels, found by finer maps (tests/support/grid_convergence.h).
    const auto finer = tests::render(*scene, integrator("mote_single_scattering", by_steps + by_map(128)));
    const auto finest = tests::render(*scene, integrator("mote_single_scattering", by_steps + by_map(256)));
    const double coarse = tests::relative_error(a, finer), fine = tests::relative_error(finer, finest);
    const double edges = tests::grid_convergence_index({0.0, coarse, coarse + fine}, 1.0, 1.0);
    INFO("maps of 64^2, 128^2 and 256^2 differ by " << coarse << " and " << fine);
    CHECK(tests::relative_error(finest, b) < edges);
    CHECK(edges < 0.01);  // what the comparison would see
    // A light that names no fog stands in it all the same: there is one outermost medium.
    const auto c = tests::render(*unnamed, map);
    CHECK(c.statistics.values.at("shadow_maps") == 1.0);
    CHECK(c.pixels == a.pixels);
    const auto text = [&](const Scene& s) {
        return tests::integrator_from(map)->plan(s, find_requirements(s)).to_text();
    };
    CHECK(text(*unnamed) == text(*scene));
    CHECK(text(*scene).find("shadow map of 64^2") != std::string::npos);
}
