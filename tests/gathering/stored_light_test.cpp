// Light that arrives at surfels, from every source, and radiosity between them.
#include "gathering/stored_light/arriving_light.h"
#include "gathering/stored_light/lit_points.h"
#include "tests/gathering/furnace_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using namespace mote::tests;

namespace {

/// A scene with its surfels, and the sides of them that reflect.
struct Stage {
    std::unique_ptr<Scene> scene;
    SurfaceTriangles surfaces;
    Surfels surfels;
    PointHierarchy hierarchy;
    SurfelSides sides;

    Stage(const std::string& xml, std::uint32_t points)
        : scene(scene_from("<scene version=\"3.0.0\">" + xml + "<sensor type=\"perspective\"/></scene>")),
          surfaces(surface_triangles(scene->shapes())),
          surfels(blue_noise_surfels(surfaces, points)),
          hierarchy(surfels),
          sides(surfaces, scene->shapes(), surfels) {}

    const Vec3& position(std::size_t place) const { return surfels.positions[sides.surfel(place)]; }
    Vec3 normal(std::size_t place) const {
        return (sides.back(place) ? -1.0f : 1.0f) * surfels.normals[sides.surfel(place)];
    }
};

const std::string floor_with = R"(<shape type="rectangle">{}</shape>)";
const std::string white = R"(<bsdf type="diffuse"><rgb name="reflectance" value="1"/></bsdf>)";
const std::string lamp =
    R"(<emitter type="point"><point name="position" x="0.3" y="0.2" z="2"/><rgb name="intensity" value="3, 2, 1"/></emitter>)";

std::string ball(double radius, bool inwards, double reflectance) {
    return fmt::format(R"(<shape type="sphere"><float name="radius" value="{}"/>
        <boolean name="flip_normals" value="{}"/><bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf></shape>)",
                       radius, inwards, reflectance);
}

}  // namespace

TEST_CASE("sides of surfels are those that reflect, with what they reflect", "[stored_light]") {
    const std::string diffuse =
        R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.4, 0.6"/></bsdf>)";
    const auto sides = [&](const std::string& bsdf) {
        const Stage stage(fmt::format(fmt::runtime(floor_with), bsdf) + lamp, 50);
        std::array<std::size_t, 2> count{};
        for (std::size_t i = 0; i < stage.sides.size(); ++i) ++count[stage.sides.back(i)];
        return count;
    };
    CHECK(sides(diffuse) == std::array<std::size_t, 2>{50, 0});
    CHECK(sides(R"(<bsdf type="twosided">)" + diffuse + "</bsdf>") == std::array<std::size_t, 2>{50, 50});
    CHECK(sides(R"(<bsdf type="conductor"/>)") == std::array<std::size_t, 2>{0, 0});
    CHECK(sides(R"(<bsdf type="roughconductor"/>)") == std::array<std::size_t, 2>{50, 0});

    const Stage stage(
        fmt::format(fmt::runtime(floor_with), R"(<bsdf type="twosided">)" + diffuse + "</bsdf>") + lamp, 50);
    const auto sent = stage.sides.reflected(std::vector<Rgb>(100, Rgb(pi)));
    REQUIRE(sent.front.size() == 50);
    REQUIRE(sent.back.size() == 50);
    for (const auto& light : {sent.front, sent.back})
        for (const Rgb& l : light) CHECK(glm::distance(l, Rgb(0.2f, 0.4f, 0.6f)) < 1e-6f);
}

TEST_CASE("direct light of point lights arrives as its closed form, on either side", "[stored_light]") {
    const std::string below =
        R"(<emitter type="point"><point name="position" x="-0.4" y="0.1" z="-1"/><rgb name="intensity" value="3, 2, 1"/></emitter>)";
    for (const bool back : {false, true}) {
        const Stage stage(
            fmt::format(fmt::runtime(floor_with), R"(<bsdf type="twosided">)" + white + "</bsdf>") +
                (back ? below : lamp),
            400);
        const ArrivedLight light = direct_light_at(*stage.scene, stage.sides, 1, 1, {});
        REQUIRE(stage.sides.size() == 800);
        for (std::size_t i = 0; i < stage.sides.size(); ++i) {
            const Vec3 to = (back ? Vec3(-0.4f, 0.1f, -1.0f) : Vec3(0.3f, 0.2f, 2.0f)) - stage.position(i);
            const float cosine = std::max(0.0f, glm::dot(glm::normalize(to), stage.normal(i)));
            const Rgb expected = Rgb(3, 2, 1) * cosine / glm::dot(to, to);
            CHECK(glm::distance(light.irradiance[i], expected) <= 1e-5f * glm::length(expected));
        }
    }
}

// Directions and sampled lights are weighted against each other: a sky of radiance 1 brings pi, whatever is
// in the way brings nothing.
TEST_CASE("direct light of a sky has its mean", "[stored_light][statistics]") {
    const Stage stage(ball(1.0, false, 1.0) + R"(<emitter type="constant"/>)", 500);
    const ArrivedLight light = direct_light_at(*stage.scene, stage.sides, 4, 1, {});
    Trials trials;
    for (const Rgb& e : light.irradiance) trials.add(double(e.x));
    CAPTURE(trials.mean(), trials.error());
    // On a convex body nothing is in the way, and the estimate has no noise but that of rounding.
    CHECK(std::fabs(trials.mean() / double(pi) - 1.0) < 1e-3 + 4.5 * trials.error() / double(pi));
    CHECK_FALSE(std::fabs(trials.mean() / (2.0 * double(pi)) - 1.0) <
                1e-3 + 4.5 * trials.error() / double(pi));  // planted: without the cosine
}

TEST_CASE("a virtual point light arrives as its geometry term, bounded or not", "[stored_light]") {
    const Stage stage(fmt::format(fmt::runtime(floor_with), white) + lamp, 300);
    lights::VplSet vpls;
    vpls.paths = 1;
    lights::VirtualPointLight vpl;
    vpl.position = {0.2f, -0.1f, 0.5f}, vpl.normal = vpl.shading_normal = {0, 0, -1};
    vpl.intensity = {1.0f, 0.5f, 2.0f};
    vpls.lights.push_back(vpl);
    for (const float bound : {infinity, 1.0f}) {
        const ArrivedLight light = vpl_light_at(*stage.scene, stage.sides, vpls, bound, {});
        for (std::size_t i = 0; i < stage.sides.size(); ++i) {
            const Vec3 to = vpl.position - stage.position(i);
            const float d2 = glm::dot(to, to), g = sqr(to.z) / sqr(d2);
            const Rgb expected = vpl.intensity * std::min(g, bound);
            CHECK(glm::distance(light.irradiance[i], expected) <= 1e-4f * glm::length(expected));
        }
    }
}

TEST_CASE("photons arrive with their power per area", "[stored_light][statistics]") {
    const Stage stage(fmt::format(fmt::runtime(floor_with), white) + lamp, 3000);
    // Half a million over the rectangle of 4 m^2, of 2 W/m^2, from straight above and at random.
    std::vector<Photon> photons(500000);
    Rng rng(3);
    for (Photon& p : photons) {
        p.position = Vec3(2.0f * rng.next_float() - 1.0f, 2.0f * rng.next_float() - 1.0f, 0.0f);
        p.towards_light = encode_direction({0, 0, 1}), p.power = Rgb(2.0f * 4.0f / 500000.0f);
        p.normal_or_medium = encode_normal({0, 0, 1}), p.depth = 2;
    }
    const SurfacePhotonMap map(std::move(photons));
    const ArrivedLight light = photon_light_at(stage.sides, map, {50, 1.0f}, {});
    Trials inner;
    for (std::size_t i = 0; i < stage.sides.size(); ++i)
        if (max_component(glm::abs(stage.position(i))) < 0.95f) inner.add(double(light.irradiance[i].x));
    CAPTURE(inner.mean(), inner.error());
    CHECK(inner.is(2.0));
    CHECK_FALSE(inner.is(2.0 * 50 / 49));
}

TEST_CASE("radiosity in a closed furnace is E / (1 - rho)", "[stored_light][radiosity]") {
    const double rho = 0.6;
    const Stage stage(ball(1.5, true, rho) + lamp, 600);
    const MicroBuffers buffers(stage.hierarchy, {.side = 6});
    for (const auto& [bounces, level] : {std::pair{0, 0u}, {1, 0u}, {3, 0u}, {3, 4u}, {30, 4u}}) {
        const auto light =
            point_radiosity(stage.hierarchy, buffers, stage.sides,
                            std::vector<Rgb>(stage.sides.size(), Rgb(1.0f)), {bounces, level, 1, {}});
        const auto expected = float((1.0 - std::pow(rho, bounces + 1)) / (1.0 - rho));
        for (const Rgb& e : light) CHECK(std::fabs(e.x / expected - 1.0f) < 1e-5f);
        // A bounce more is seen, but where no more than rho^30 is left.
        const auto wrong = float((1.0 - std::pow(rho, bounces + 2)) / (1.0 - rho));
        CHECK((std::fabs(light[0].x / wrong - 1.0f) > 1e-5f) == (bounces < 30));
    }
}

// Concentric balls: F_io = 1, F_oi = (r/R)^2, F_oo = 1 - F_oi, and light is even on each. The cut is so fine
// that buffers see discs alone, of radius r_d, which stand out beyond the true silhouette by r_d^2 / (2 r), a
// fraction of r_d^2 / r^2 of the area seen.
TEST_CASE("radiosity between two balls is the solution of their two equations", "[stored_light][radiosity]") {
    const double small = 1.0, large = 2.0, rho_i = 0.5, rho_o = 0.8, f = small * small / (large * large);
    const Stage stage(ball(small, false, rho_i) + ball(large, true, rho_o) + lamp, 5000);
    const MicroBuffers buffers(stage.hierarchy, {.side = 12, .cut = 0.01f});
    std::vector<Rgb> arriving(stage.sides.size());
    const auto inner = [&](std::size_t i) { return glm::length(stage.position(i)) < 1.5f; };
    for (std::size_t i = 0; i < arriving.size(); ++i) arriving[i] = Rgb(inner(i) ? 1.0f : 0.0f);
    const auto light = point_radiosity(stage.hierarchy, buffers, stage.sides, arriving, {30, 5, 1, {}});
    // E_i = 1 + rho_o E_o, E_o = f rho_i E_i + (1 - f) rho_o E_o.
    const double e_o = f * rho_i / (1.0 - (1.0 - f) * rho_o - f * rho_i * rho_o), e_i = 1.0 + rho_o * e_o;
    Trials of_inner, of_outer;
    for (std::size_t i = 0; i < light.size(); ++i) (inner(i) ? of_inner : of_outer).add(double(light[i].x));
    const double disc = double(stage.surfels.radius) / small;
    const double gain = 1.0 / (1.0 - rho_o);  // of light that is not taken by the inner ball
    const double most = gain * disc * disc + 1e-3;
    CAPTURE(of_inner.mean(), e_i, of_outer.mean(), e_o, most);
    CHECK(std::fabs(of_inner.mean() / e_i - 1.0) < most);
    CHECK(std::fabs(of_outer.mean() / e_o - 1.0) < most);
    CHECK_FALSE(std::fabs(of_outer.mean() / (0.9 * e_o) - 1.0) < most);
}

TEST_CASE("places gather for those that face their way, and for no others", "[stored_light][radiosity]") {
    const Stage stage(R"(<shape type="cube">)" + white + "</shape>" + lamp, 999);
    const auto all = gathering_places(stage.hierarchy, stage.sides, 0);
    CHECK(all.gather.size() == stage.sides.size());
    const auto few = gathering_places(stage.hierarchy, stage.sides, 24);
    CHECK(few.gather.size() == 6);
    const auto some = gathering_places(stage.hierarchy, stage.sides, 3);
    CHECK(some.gather.size() < stage.sides.size() / 4);
    for (const auto* places : {&all, &few, &some})
        for (std::size_t i = 0; i < stage.sides.size(); ++i)
            CHECK(glm::dot(stage.normal(i), stage.normal(places->gather[places->by[i]])) > 0.9f);
}
