// Epipolar lines for lights everywhere, and pictures from one pixel to a row of 8192.
#include "screenspace/epipolar/epipolar_lines.h"

#include <algorithm>

#include "core/math/random.h"
#include "core/scene/scene.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;

namespace {

struct Case {
    std::string name;
    FilmPoint light;
};

/// In front, behind and beside the camera; inside, outside, on the border, on a corner, on a pixel's centre.
std::vector<Case> lights_around(double w, double h) {
    std::vector<Case> cases;
    const std::vector<std::pair<std::string, Vec2d>> places = {
        {"in the middle", {0.5 * w, 0.5 * h}},
        {"on a pixel's centre", {std::floor(0.3 * w) + 0.5, std::floor(0.7 * h) + 0.5}},
        {"on the left border", {0.0, 0.4 * h}},
        {"on the lower border", {0.3 * w, h}},
        {"on a corner", {w, 0.0}},
        {"left of the picture", {-0.7 * w - 3.0, 0.6 * h}},
        {"beyond a corner", {1.8 * w, 2.0 * h}},
        {"just outside", {w + 1e-9, 0.2 * h}},
        {"just inside", {w - 1e-9, 0.2 * h}},
        {"far away", {1e7 * w, -3e6 * h}}};
    for (const auto& [name, p] : places)
        for (const double depth : {2.0, -2.0, 1e-5, -1e-5})
            cases.push_back(
                {name + (depth > 0 ? ", in front" : ", behind"), {depth * p.x, depth * p.y, depth}});
    cases.push_back({"beside the camera", {3.0, 4.0, 0.0}});
    cases.push_back({"beside the camera, along the rows", {-2.0, 0.0, 0.0}});
    return cases;
}

double cross(const Vec2d& a, const Vec2d& b) { return a.x * b.y - a.y * b.x; }

/// How far p is from the line through the light and q, as a fraction of the distances involved.
double off_line(const FilmPoint& light, const Vec2d& p, const Vec2d& q) {
    const Vec2d to_light = Vec2d(light.x, light.y) - light.w * q;
    const double length = glm::length(to_light);
    return length > 0.0 ? std::abs(cross(p - q, to_light)) / length : 0.0;
}

void check_lines(const Case& c, double w, double h, int count, double offset) {
    INFO(c.name << ", " << w << " x " << h << ", " << count << " lines");
    const FilmRectangle frame{{0.0, 0.0}, {w, h}};
    const EpipolarLines lines(c.light, frame, count, offset);
    REQUIRE(lines.lines().size() >= 1);
    REQUIRE(lines.lines().size() <= std::size_t(count) + 3);
    const double rounding = 1e-9 * (w + h);
    for (const EpipolarLine& line : lines.lines()) {
        for (const Vec2d& p : {line.start, line.end}) {
            CHECK(p.x >= -rounding);
            CHECK(p.x <= w + rounding);
            CHECK(p.y >= -rounding);
            CHECK(p.y <= h + rounding);
        }
        CHECK(off_line(c.light, line.start, line.end) <= 1e-6);
    }
    // Every point lies between its two lines (on different sides of them), and they are neighbours.
    Rng rng(7);
    int between = 0;
    const std::size_t n = lines.lines().size();
    for (int i = 0; i < 200; ++i) {
        const Vec2d p(w * double(rng.next_float()), h * double(rng.next_float()));
        const auto [before, after] = lines.around(p);
        REQUIRE(before < n);
        REQUIRE(after < n);
        if (n == 1) continue;
        CHECK((before + 1) % n == after);
        const EpipolarLine &a = lines.lines()[before], &b = lines.lines()[after];
        const double spacing = frame.perimeter() / count;
        const double distance =
            std::min(glm::length(p - a.at(a.project(p))), glm::length(p - b.at(b.project(p))));
        CHECK(distance <= spacing + (lines.light_inside() ? 0.5 : 0.0) + rounding);
        if (a.length() < 1e-6 || b.length() < 1e-6) continue;
        const Vec2d u = glm::normalize(a.end - a.start), v = glm::normalize(b.end - b.start);
        if (cross(u, v) < -1e-6 || glm::dot(u, v) < -0.999) continue;  // half a turn or more between them
        ++between;
        const double left = cross(a.end - a.start, p - a.start) / a.length();
        const double right = cross(b.end - b.start, p - b.start) / b.length();
        CHECK(left >= -1e-5);
        CHECK(right <= 1e-5);
    }
    if (n >= 8) CHECK(between > 20);
}

}  // namespace

TEST_CASE("Epipolar lines cover the picture wherever the light is", "[epipolar]") {
    const std::vector<std::pair<double, double>> sizes = {
        {1920, 1080}, {64, 48}, {1, 1}, {8192, 1}, {1, 8192}};
    for (const auto& [w, h] : sizes)
        for (const Case& c : lights_around(w, h))
            for (const int count : {1, 7, 256}) check_lines(c, w, h, count, 0.37);
}

TEST_CASE("Epipolar lines end evenly along the border", "[epipolar]") {
    const EpipolarLines lines({32.0, 24.0, 1.0}, {{0, 0}, {64, 48}}, 224, 0.25);
    REQUIRE(lines.lines().size() == 224);
    for (std::size_t i = 0; i < 63; ++i) {  // the upper side, one a pixel
        CHECK(lines.lines()[i].end.x == Approx(double(i) + 0.25));
        CHECK(lines.lines()[i].end.y == 0.0);
        CHECK(glm::length(lines.lines()[i].start - Vec2d(32.0, 24.0)) == Approx(0.5));
    }
}

TEST_CASE("A light at the eye has no epipolar lines", "[epipolar]") {
    CHECK_THROWS_AS(EpipolarLines({0, 0, 0}, {{0, 0}, {4, 4}}, 8, 0.0), std::invalid_argument);
    CHECK_THROWS_AS(EpipolarLines({1, 1, 1}, {{0, 0}, {4, 4}}, 0, 0.0), std::invalid_argument);
    CHECK_THROWS_AS(EpipolarLines({1, 1, 1}, {{0, 0}, {0, 4}}, 8, 0.0), std::invalid_argument);
}

TEST_CASE("Points of eye rays are projected to where the rays start on the film", "[epipolar]") {
    const std::vector<std::string> sensors = {
        R"(<sensor type="perspective"><float name="fov" value="50"/>)",
        R"(<sensor type="thinlens"><float name="aperture_radius" value="0.2"/><float name="focus_distance" value="3"/>)",
        R"(<sensor type="orthographic">)"};
    for (const std::string& sensor : sensors) {
        INFO(sensor);
        const auto scene = tests::scene_from(R"(<scene version="3.0.0"><emitter type="constant"/>)" + sensor +
                                                 R"(<transform name="to_world"><lookat origin="1, 2, 3"
                                                 target="0, -1, 0.5" up="0, 1, 0"/></transform></sensor></scene>)",
                                             64);
        const Vec2 lens(0.2f, 0.9f);
        const FilmProjection projection(scene->camera(), 64, 64, lens);
        Rng rng(3);
        for (int i = 0; i < 100; ++i) {
            const Vec2 film(64.0f * rng.next_float(), 64.0f * rng.next_float());
            const Ray ray = scene->camera().sample_ray(film, lens);
            const float t = 0.1f + 5.0f * rng.next_float();
            for (const float along : {t, -t}) {  // behind the camera too: the same line, the other way
                const FilmPoint p = projection.project(Vec3d(ray.at(along)), 1e-6);
                CHECK(p.x / p.w == Approx(film.x).margin(2e-3));
                CHECK(p.y / p.w == Approx(film.y).margin(2e-3));
                if (sensor.find("orthographic") == std::string::npos) CHECK((p.w > 0.0) == (along > 0.0f));
            }
        }
        if (sensor.find("perspective") == std::string::npos) continue;
        const FilmPoint eye = projection.project(Vec3d(scene->camera().position()), 1e-6);
        CHECK((eye.x == 0.0 && eye.y == 0.0 && eye.w == 0.0));
    }
}
