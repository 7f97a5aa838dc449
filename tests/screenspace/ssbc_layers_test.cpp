// Several layers of surfaces: that each holds the surface it says, and that compensation with them is the one
// of a picture in which nothing is hidden.
#include "screenspace/ssbc/ssbc_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "core/scene/scene.h"
#include "screenspace/g_buffer/g_buffer.h"
#include "screenspace/ssbc/ssbc.h"
#include "tests/screenspace/ssbc_pictures.h"
#include "tests/screenspace/ssbc_wedge.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

const std::string view = R"(<emitter type="point"><point name="position" x="0" y="0" z="3"/></emitter>
    <sensor type="perspective"><float name="fov" value="50"/><transform name="to_world">
    <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
const std::string one_sided =
    R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.4, 0.6"/></bsdf>)";
const std::string twosided = "<bsdf type=\"twosided\">" + one_sided + "</bsdf>";

std::string rectangle(const std::string& transform, const std::string& bsdf) {
    return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform + "</transform>" + bsdf +
           "</shape>";
}

/// A wedge as in ssbc_exact_test.cpp, and a black board before the camera that hides the wall but not the
/// floor: its lower border runs through the middle of the picture, as the edge does.
const std::vector<Wall> wedge_walls = {{{0, 0, 0}, {50, 0, 0}, {0, 0, -50}, Rgb(0.9f)},
                                       {{0, 0, 0}, {50, 0, 0}, {0, 50, 0}, Rgb(0.9f)}};
const Pinhole wedge_camera{{0.2, 3, 3}, {0, 0, 0}, {0.1, 1, 0}, std::tan(0.45), 96, 96};

Wall board() {
    const Vec3d f = glm::normalize(wedge_camera.target - wedge_camera.eye),
                r = glm::normalize(glm::cross(f, wedge_camera.up)), u = glm::cross(r, f);
    return {wedge_camera.eye + f + 3.0 * u, 3.0 * r, 3.0 * u, Rgb(0.0f)};
}

/// Seen surfaces, and those that the board hides.
struct TwoLayers {
    TestPicture seen = picture_of({wedge_walls[0], wedge_walls[1], board()}, wedge_camera);
    TestPicture all = picture_of(wedge_walls, wedge_camera);
    std::vector<HiddenSide> hidden;

    TwoLayers() {
        TestPicture behind = all;
        for (std::size_t i = 0; i < behind.light.size(); ++i)
            if (seen.wall[i] != 2) behind.surfaces.area[i] = 0.0f, behind.light[i] = Rgb(0.0f);
        hidden.push_back({behind.surfaces, behind.light});
    }
};

SsbcSettings settings(float bound, int steps, bool hierarchical = true) {
    SsbcSettings s;
    s.bound = bound, s.steps = steps, s.hierarchical = hierarchical;
    s.refinement.projected_angle = 0.02f, s.refinement.discontinuity_projected_angle = 0.01f;
    s.grazing_angle = 0.5f * pi;
    return s;
}

/// Sum over pixels of the floor near the edge, relative to another picture: bias and rms.
struct Comparison {
    double bias = 0.0, rms = 0.0;
};
Comparison on_the_floor(const TwoLayers& layers, const std::vector<Rgb>& found,
                        const std::vector<Rgb>& exact) {
    double difference = 0.0, squares = 0.0, sum = 0.0, sum_squares = 0.0;
    int n = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Vec3 p = layers.seen.surfaces.position[i];
        if (layers.seen.wall[i] != 0 || std::abs(p.x) > 0.4f || p.z > 0.8f) continue;
        const double e = double(exact[i].x), d = double(found[i].x) - e;
        difference += d, squares += d * d, sum += e, sum_squares += e * e, ++n;
    }
    REQUIRE(n > 100);
    return {difference / sum, std::sqrt(squares / sum_squares)};
}

/// A patch that looks up, and a hidden one above it that looks down.
struct Pair {
    SsbcSurfaces seen{1, 1};
    HiddenSide hidden{SsbcSurfaces(1, 1), {Rgb(4.0f)}};
    std::vector<Rgb> light = {Rgb(3.0f)};
    Pair(float distance, const Vec3& looks = {0, 0, -1}) {
        seen.set(0, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 1e-4f, Rgb(0.5f));
        hidden.surfaces.set(0, {0, 0, distance}, looks, looks, 1e-4f, Rgb(0.25f));
    }
    float step(int steps) const {
        return compensate(seen, light, {&hidden, 1}, settings(1.0f, steps)).compensation[0].x;
    }
};

}  // namespace

TEST_CASE("Layer k holds the k-th surface along each ray", "[g_buffer][layers]") {
    // Rectangles in all positions, found here one by one in double precision.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::string xml = "<scene version=\"3.0.0\">";
    std::vector<Wall> walls;
    const double radians = std::acos(-1.0) / 180.0;
    for (int k = 0; k < 25; ++k) {
        const double a = 180.0 * uniform(random), b = 60.0 * uniform(random),
                     s = 0.3 + 0.25 * uniform(random);
        const Vec3d c(uniform(random), uniform(random), uniform(random));
        xml +=
            rectangle(fmt::format(R"(<scale value="{}"/><rotate z="1" angle="{}"/><rotate y="1" angle="{}"/>
            <translate x="{}" y="{}" z="{}"/>)",
                                  s, a, b, c.x, c.y, c.z),
                      twosided);
        const auto turned = [&](const Vec3d& v) {
            const Vec3d w(std::cos(a * radians) * v.x - std::sin(a * radians) * v.y,
                          std::sin(a * radians) * v.x + std::cos(a * radians) * v.y, 0.0);
            return Vec3d(std::cos(b * radians) * w.x, w.y, -std::sin(b * radians) * w.x);
        };
        walls.push_back({c, turned({s, 0, 0}), turned({0, s, 0})});
    }
    const int size = 48, layers = 8;
    const auto scene = scene_from(xml + view, size);
    const auto buffers = make_g_buffers(*scene, scene->camera(), size, size, layers);
    int deepest = 0, compared = 0;
    for (std::size_t i = 0; i < buffers[0].pixel_count(); ++i) {
        const Vec3d o(0, 0, 3), d(buffers[0].view[i]);
        std::vector<double> found;
        bool at_a_border = false;  // where rounding decides whether it is met
        for (const Wall& w : walls) {
            const double t = glm::dot(w.centre - o, w.normal()) / glm::dot(d, w.normal());
            const Vec3d local = o + t * d - w.centre;
            const double x = std::abs(glm::dot(local, w.u)) / glm::dot(w.u, w.u),
                         y = std::abs(glm::dot(local, w.v)) / glm::dot(w.v, w.v);
            at_a_border |= t > 0.0 && std::max(x, y) > 1.0 - 1e-4 && std::max(x, y) < 1.0 + 1e-4;
            if (t > 0.0 && x < 1.0 && y < 1.0) found.push_back(t);
        }
        if (at_a_border) continue;
        std::sort(found.begin(), found.end());
        deepest = std::max(deepest, int(found.size()));
        for (std::size_t k = 0; k < std::size_t(layers); ++k) {
            REQUIRE((buffers[k].hit[i] != 0) == (k < found.size()));
            if (k >= found.size()) continue;
            CHECK(double(buffers[k].distance[i]) == Approx(found[k]).epsilon(1e-5));
            CHECK(glm::dot(buffers[k].geometric_normal[i], buffers[k].view[i]) < 0.0f);
            ++compared;
        }
    }
    CHECK(deepest > 4);
    CHECK(compared > 2000);
    CHECK_THROWS_AS(make_g_buffers(*scene, scene->camera(), size, size, 0), std::invalid_argument);
}

TEST_CASE("Sheets a hundredth of a millimetre apart are all found, and once each", "[g_buffer][layers]") {
    // An odd number of pixels: rays of the middle row, column and diagonal run along the triangles' edges.
    const int size = 33, sheets = 5;
    std::string xml = "<scene version=\"3.0.0\">";
    for (int k = 0; k < sheets; ++k)
        xml += rectangle(fmt::format(R"(<scale value="4"/><translate z="{}"/>)", -1e-5 * k), one_sided);
    const auto scene = scene_from(xml + view, size);
    const auto buffers = make_g_buffers(*scene, scene->camera(), size, size, sheets + 1);
    const auto count_with_offset = [&](float offset, std::size_t pixel) {
        Ray ray{{0, 0, 3}, buffers[0].view[pixel]};
        int count = 0;
        while (const auto hit = scene->rays().closest(ray)) ray.t_min = hit->t + offset, ++count;
        return count;
    };
    int lost = 0;
    for (std::size_t i = 0; i < buffers[0].pixel_count(); ++i) {
        for (int k = 0; k <= sheets; ++k) CHECK(int(buffers[std::size_t(k)].hit[i]) == int(k < sheets));
        lost += count_with_offset(1e-4f, i) < sheets;
    }
    CHECK(lost > 0);  // planted: a fixed offset, as is often used, loses sheets
}

TEST_CASE("Which sides reflect is up to the BSDF", "[ssbc][layers]") {
    const auto scene =
        scene_from("<scene version=\"3.0.0\">" + rectangle("", twosided) +
                       rectangle("<translate z=\"-1\"/>", one_sided) +
                       rectangle("<rotate y=\"1\" angle=\"180\"/><translate z=\"-2\"/>", one_sided) + view,
                   9);
    const auto buffers = make_g_buffers(*scene, scene->camera(), 9, 9, 4);
    const std::size_t middle = buffers[0].index(4, 4);
    const auto sides = hidden_sides(buffers);
    REQUIRE(sides.size() == hidden_side_count(4));
    struct Expected {
        const char* name;
        float z, normal;  // 0: takes no part
    };
    const Expected expected[] = {{"1_back", 0, -1},  {"2", -1, 1}, {"2_back", -1, 0}, {"3", -2, 0},
                                 {"3_back", -2, -1}, {"4", 0, 0},  {"4_back", 0, 0}};
    for (std::size_t s = 0; s < sides.size(); ++s) {
        INFO("side " << hidden_side_name(s));
        CHECK(hidden_side_name(s) == expected[s].name);
        CHECK((sides[s].area[middle] > 0.0f) == (expected[s].normal != 0.0f));
        if (expected[s].normal == 0.0f) continue;
        CHECK(sides[s].normal[middle].z == Approx(expected[s].normal));
        CHECK(sides[s].position[middle].z == Approx(expected[s].z).margin(1e-5));
        CHECK(sides[s].reflectance[middle].y == Approx(0.4f));
    }
    CHECK(hidden_side_count(1) == 0);
    CHECK(hidden_sides(std::span(buffers).first(1)).empty());
}

TEST_CASE("A wall behind a board lights the floor as if the board were not there", "[ssbc][layers]") {
    const TwoLayers layers;
    for (const bool hierarchical : {false, true})
        for (const int steps : {1, 3}) {
            const SsbcSettings s = settings(1.0f, steps, hierarchical);
            const auto exact = compensate(layers.all.surfaces, layers.all.light, s).compensation;
            const auto one = compensate(layers.seen.surfaces, layers.seen.light, s).compensation;
            const auto two =
                compensate(layers.seen.surfaces, layers.seen.light, layers.hidden, s).compensation;
            const Comparison with = on_the_floor(layers, two, exact),
                             without = on_the_floor(layers, one, exact);
            INFO(steps << " steps, hierarchical " << hierarchical << ": rms " << with.rms << ", bias "
                       << with.bias << "; with one layer " << without.bias);
            CHECK(without.bias < -0.9);  // a few pixels of the wall are seen below the board
            // The same patches, on another side, up to the order of sums.
            CHECK(with.rms < 1e-5);
            for (std::size_t i = 0; i < two.size(); ++i)
                if (layers.seen.wall[i] == 2) REQUIRE(two[i] == Rgb(0.0f));  // the board stays black
        }
}

TEST_CASE("Light of a hidden wall is that of quadrature, and planted errors are found",
          "[ssbc][layers][planted]") {
    const TwoLayers layers;
    const WedgeLight exact = WedgeLight(4.0, 1.0).step(1.0, 0.9);
    std::vector<Rgb> expected(layers.seen.light.size(), Rgb(0.0f));
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) {
            const std::size_t i = layers.seen.index(x, y);
            double sum = 0.0;  // over the pixel
            for (int k = 0; k < 16; ++k) {
                const auto d = wedge_camera.direction(x + (k % 4 + 0.5) / 4, y + (k / 4 + 0.5) / 4);
                const auto hit = first_hit(wedge_walls, wedge_camera.eye, d);
                if (hit) sum += exact(std::max(0.0, (wedge_camera.eye + hit->t * d).z)) / 16.0;
            }
            expected[i] = Rgb(float(sum));
        }
    const auto bias = [&](const std::vector<HiddenSide>& hidden) {
        const auto found =
            compensate(layers.seen.surfaces, layers.seen.light, hidden, settings(1.0f, 1)).compensation;
        return std::abs(on_the_floor(layers, found, expected).bias);
    };
    CHECK(bias(layers.hidden) < 0.015);
    auto wrong = layers.hidden;
    for (Rgb& l : wrong[0].reflected) l *= 1.04f;
    CHECK_FALSE(bias(wrong) < 0.015);
    wrong = layers.hidden;
    for (Vec3& p : wrong[0].surfaces.position) p.z -= 0.02f;  // of a radius of 1 m
    CHECK_FALSE(bias(wrong) < 0.015);
    wrong = layers.hidden;
    for (Vec3& n : wrong[0].surfaces.normal) n = -n;  // the side that faces away
    CHECK_FALSE(bias(wrong) < 0.9);
}

TEST_CASE("Layers without surfaces change no bit", "[ssbc][layers]") {
    const TestPicture picture =
        picture_of(wedge_walls, {{0.2, 3, 3}, {0, 0, 0}, {0.1, 1, 0}, std::tan(0.45), 72, 40});
    for (const bool half : {false, true}) {
        SsbcSettings s = settings(1.0f, 2);
        s.half_resolution = half, s.blur = half ? 1.0f : 0.0f;
        const std::vector<HiddenSide> sky(3, {SsbcSurfaces(72, 40), std::vector<Rgb>(72 * 40, Rgb(1.0f))});
        CHECK(compensate(picture.surfaces, picture.light, sky, s).compensation ==
              compensate(picture.surfaces, picture.light, s).compensation);
    }
}

TEST_CASE("Hidden patches send in the first step and receive in the second", "[ssbc][layers]") {
    const float d = 0.5f, g = (1.0f / (d * d) - 1.0f) * 1e-4f * inv_pi;
    const Pair pair(d);
    CHECK(pair.step(1) == Approx(0.5f * g * 4.0f).epsilon(1e-3));
    CHECK(pair.step(2) - pair.step(1) == Approx(0.5f * g * 0.25f * g * 3.0f).epsilon(0.02));
    CHECK(Pair(d, {0, 0, 1}).step(1) == 0.0f);  // faces away
    CHECK(Pair(1.1f).step(1) == 0.0f);          // beyond the bound's radius
    Pair dark(d);
    dark.hidden.reflected[0] = Rgb(0.0f);
    CHECK(dark.step(3) == 0.0f);  // no light came there: none is handed on either
    Pair broken(d);
    broken.hidden.reflected[0] = Rgb(std::nanf(""));
    const SsbcResult r = compensate(broken.seen, broken.light, {&broken.hidden, 1}, settings(1.0f, 2));
    CHECK(r.non_finite == 1);
    CHECK(r.compensation[0] == Rgb(0.0f));
}

TEST_CASE("Sides of a wrong size are refused", "[ssbc][layers]") {
    Pair pair(0.5f);
    pair.hidden.reflected.emplace_back(1.0f);
    CHECK_THROWS_AS(pair.step(1), std::invalid_argument);
    Pair other(0.5f);
    other.hidden.surfaces = SsbcSurfaces(1, 2);
    CHECK_THROWS_AS(other.step(1), std::invalid_argument);
}

TEST_CASE("What matters is what can send light that comes to be seen", "[ssbc][layers]") {
    const auto matters = [](const Pair& pair, int steps) {
        return int(sides_that_matter(pair.seen, {&pair.hidden.surfaces, 1}, settings(1.0f, steps))[0][0]);
    };
    CHECK(matters(Pair(0.5f), 1) == 1);
    CHECK(matters(Pair(1.1f), 3) == 0);
    CHECK(matters(Pair(0.5f, {0, 0, 1}), 3) == 0);
    // One beside the picture's own that only the first hidden patch sees, from the second step on.
    Pair pair(0.5f);
    std::vector<SsbcSurfaces> sides = {pair.hidden.surfaces, SsbcSurfaces(1, 1)};
    sides[1].set(0, {0, 0, -0.3f}, {0, 0, 1}, {0, 0, 1}, 1e-4f, Rgb(0.5f));
    const auto after = [&](int steps) {
        return int(sides_that_matter(pair.seen, sides, settings(1.0f, steps))[1][0]);
    };
    CHECK(after(1) == 0);
    CHECK(after(2) == 1);
}

TEST_CASE("Light comes through a thin wall from behind it", "[ssbc][layers]") {
    // A floor, a wall on it, and another close behind that one: it faces the floor before both.
    const auto scene = scene_from(
        "<scene version=\"3.0.0\">" +
            rectangle("<scale value=\"3\"/><rotate x=\"1\" angle=\"-90\"/><translate y=\"-1\"/>", twosided) +
            rectangle("<scale value=\"3\"/><translate z=\"-0.2\" y=\"1\"/>", twosided) +
            rectangle("<scale value=\"3\"/><translate z=\"-0.3\" y=\"1\"/>", twosided) + view,
        40);
    const auto buffers = make_g_buffers(*scene, scene->camera(), 40, 40, 2);
    const SsbcSurfaces seen = ssbc_surfaces(buffers[0]);
    std::vector<HiddenSide> hidden;
    for (const SsbcSurfaces& side : hidden_sides(buffers))
        hidden.push_back({side, std::vector<Rgb>(1600, Rgb(hidden.size() == 1 ? 1.0f : 0.0f))});
    const std::vector<Rgb> black(1600, Rgb(0.0f));
    SsbcSettings s = settings(1.0f, 1);
    const auto leak = [&] {
        const auto found = compensate(seen, black, hidden, s).compensation;
        double sum = 0.0;
        for (std::size_t i = 0; i < found.size(); ++i)
            if (seen.normal[i].y > 0.5f && seen.position[i].z > -0.19f) sum += double(found[i].x);
        return sum;
    };
    CHECK(leak() > 0.1);
}
