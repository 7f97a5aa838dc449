// Form factors by micro-buffers against closed forms, and how their error falls.
#include "tests/gathering/form_factors.h"
#include "tests/gathering/micro_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using tests::element_to_rectangle;
using tests::SeedMean;
using tests::TriangleBuilder;

namespace {

constexpr double critical_z = 4.5;

/// Form factors from places of the plane z = 0 of the unit square, which faces up, to the shapes of a list.
struct FromTheFloor {
    FromTheFloor(const SurfaceTriangles& triangles, std::uint32_t points)
        : surfels(blue_noise_surfels(triangles, points)), hierarchy(surfels) {
        for (const SurfacePoint& p : surfels.places) shape_of.push_back(triangles.shape[p.triangle]);
    }
    NodeRadiance lit(std::uint32_t shape) const {
        std::vector<Rgb> front(surfels.size(), Rgb(0.0f));
        for (std::size_t i = 0; i < front.size(); ++i)
            if (shape_of[i] == shape) front[i] = Rgb(1.0f);
        return NodeRadiance(hierarchy, front);
    }
    static std::vector<MicroReceiver> receivers(int count, std::uint64_t seed) {
        std::vector<MicroReceiver> result;
        Rng rng(seed);
        for (int i = 0; i < count; ++i) {
            const Vec2 at = (Vec2(float(i % 16), float(i / 16 % 16)) + rng.next_vec2()) / 16.0f;
            result.push_back({Vec3(at, 0.0f), tests::turned_frame(Vec3(0, 0, 1), rng)});
        }
        return result;
    }
    /// Mean over receivers, with the error that 256 receivers in a grid have at most.
    SeedMean factor(std::uint32_t shape, const MicroBufferSettings& settings) const {
        const NodeRadiance radiance = lit(shape);
        const MicroBuffers buffers(hierarchy, settings);
        SeedMean mean;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const auto from = receivers(256, seed);
            std::vector<Rgb> e(from.size());
            gather_irradiance(buffers, radiance, from, e);
            double sum = 0.0;
            for (const Rgb& value : e) sum += double(value.x) / M_PI / double(e.size());
            mean.add(sum);
        }
        return mean;
    }
    /// Root mean square difference from the closed form for a unit square at height h.
    double error(std::uint32_t shape, double h, const MicroBufferSettings& settings, int count = 256) const {
        const NodeRadiance radiance = lit(shape);
        const auto from = receivers(count, 9);
        std::vector<Rgb> e(from.size());
        gather_irradiance(MicroBuffers(hierarchy, settings), radiance, from, e);
        double squares = 0.0;
        for (std::size_t i = 0; i < from.size(); ++i) {
            const double x = from[i].position.x, y = from[i].position.y;
            squares += std::pow(double(e[i].x) / M_PI - element_to_rectangle(-x, 1 - x, -y, 1 - y, h), 2.0);
        }
        return std::sqrt(squares / double(from.size()));
    }

    Surfels surfels;
    PointHierarchy hierarchy;
    std::vector<std::uint32_t> shape_of;
};

SurfaceTriangles unit_cube() { return TriangleBuilder().box(Vec3(0.0f), Vec3(1.0f), true).list(); }

SurfaceTriangles plate_above(float h) {
    return TriangleBuilder().quad({0, 1, h}, {1, 1, h}, {1, 0, h}, {0, 0, h}, 0).list();
}

}  // namespace

TEST_CASE("form factors of the unit cube by micro-buffers", "[micro_buffers][form_factors]") {
    // Shape 4 is the floor, 5 the ceiling. What faces meet in is a corner, where no disc shows beyond an
    // edge: the rest is one place a texel, 2e-3 at most on average over receivers.
    const FromTheFloor cube(unit_cube(), 20000);
    double row = 0.0;
    for (std::uint32_t shape = 0; shape < 6; ++shape) {
        const SeedMean f = cube.factor(shape, {.side = 24});
        const double expected = shape == 4 ? 0.0 : shape == 5 ? 0.1998249 : 0.2000438;
        INFO(shape << ": " << f.mean() << " +- " << f.error());
        CHECK(std::fabs(f.mean() - expected) < critical_z * f.error() + 2e-3);
        row += f.mean();
        // Five per cent of another pdf would show.
        if (shape != 4) CHECK(std::fabs(1.05 * f.mean() - expected) > critical_z * f.error() + 2e-3);
    }
    CHECK(std::fabs(row - 1.0) < 1e-6);  // the row sum holds exactly: every ray meets a face
}

TEST_CASE("form factors of parallel plates by micro-buffers", "[micro_buffers][form_factors]") {
    for (const float h : {0.25f, 0.5f, 1.0f, 2.0f}) {
        const FromTheFloor plate(plate_above(h), 20000);
        const auto from = FromTheFloor::receivers(1024, 5);
        double exact = 0.0;  // Howell's C-11 as the mean over the floor
        for (const MicroReceiver& r : from) {
            const double x = r.position.x, y = r.position.y;
            exact += element_to_rectangle(-x, 1 - x, -y, 1 - y, double(h)) / double(from.size());
        }
        if (h == 1.0f) CHECK(std::fabs(exact - 0.1998249) < 5e-4);
        const SeedMean f = plate.factor(0, {.side = 32});
        // Discs reach beyond the plate's edge, by a radius at most, and nodes by half a texel.
        const double wider =
            std::pow(1.0 + 2.0 * (double(plate.surfels.radius) + 0.5 * double(h) / 32.0), 2.0);
        INFO(h << ": " << f.mean() << " +- " << f.error() << ", exact " << exact);
        CHECK(f.mean() < exact * wider + critical_z * f.error());
        CHECK(f.mean() > exact - critical_z * f.error() - 1e-3);
    }
}

TEST_CASE("a near plate hides a far one", "[micro_buffers][form_factors]") {
    TriangleBuilder plates;
    plates.quad({-2, 2, 1}, {2, 2, 1}, {2, -2, 1}, {-2, -2, 1}, 0);
    plates.quad({0.3f, 0.7f, 0.5f}, {0.7f, 0.7f, 0.5f}, {0.7f, 0.3f, 0.5f}, {0.3f, 0.3f, 0.5f}, 1);
    const FromTheFloor scene(plates.list(), 40000);
    const NodeRadiance far = scene.lit(0);
    const auto from = FromTheFloor::receivers(256, 3);
    std::vector<Rgb> e(from.size());
    gather_irradiance(MicroBuffers(scene.hierarchy, {.side = 32, .cut = 0.25f}), far, from, e);
    double mean = 0.0, exact = 0.0, hidden = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const double x = from[i].position.x, y = from[i].position.y;
        const double near = element_to_rectangle(0.3 - x, 0.7 - x, 0.3 - y, 0.7 - y, 0.5);
        exact += (element_to_rectangle(-2 - x, 2 - x, -2 - y, 2 - y, 1.0) - near) / 256.0;
        hidden += near / 256.0, mean += double(e[i].x) / M_PI / 256.0;
    }
    // Both plates are wider by a radius of their discs, and half a node.
    INFO(mean << ", exact " << exact << ", hidden " << hidden);
    CHECK(std::fabs(mean - exact) < 0.2 * hidden);
}

TEST_CASE("the error of micro-buffers falls with texels, points and the cut",
          "[micro_buffers][form_factors]") {
    // Texels: one place for each of n^2 cells, cut by an edge: n^-1.5 where cells are cut at random.
    const FromTheFloor cube(unit_cube(), 30000);
    const double sides[] = {4, 8, 16, 32};
    double by_side[4];
    for (int i = 0; i < 4; ++i)
        by_side[i] = cube.error(5, 1.0, {.side = std::uint32_t(sides[i]), .cut = 0.25f});
    INFO("texels a side: n^" << tests::exponent(sides, by_side) << ", " << by_side[0] << " to "
                             << by_side[3]);
    CHECK(tests::exponent(sides, by_side) < -1.2);
    // Points: the rim of an open plate is as wide as a disc, one over the root of the points.
    const double counts[] = {250, 1000, 4000, 16000};
    double by_points[4];
    for (int i = 0; i < 4; ++i)
        by_points[i] = FromTheFloor(plate_above(0.5f), std::uint32_t(counts[i]))
                           .error(0, 0.5, {.side = 64, .cut = 0.25f}, 64);
    INFO("points: n^" << tests::exponent(counts, by_points) << ", " << by_points[0] << " to "
                      << by_points[3]);
    CHECK(tests::exponent(counts, by_points) < -0.4);
    // The cut: nodes as large as a texel stand out beyond the edge by half of it; the width is its root.
    const FromTheFloor plate(plate_above(0.5f), 60000);
    const double cuts[] = {16, 8, 4, 2};
    double by_cut[4];
    for (int i = 0; i < 4; ++i)
        by_cut[i] = plate.error(0, 0.5, {.side = 64, .cut = 16.0f * float(cuts[i])}, 64);
    INFO("cut: c^" << tests::exponent(cuts, by_cut) << ", " << by_cut[0] << " to " << by_cut[3]);
    CHECK(tests::exponent(cuts, by_cut) > 0.3);
}
