// Form factors by ray-bundles against closed forms: which links there are, and what each represents.
#include "tests/gathering/form_factors.h"

#include "core/geometry/analytic_shapes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using tests::form_factors;
using tests::FormFactors;
using tests::SeedMean;
using tests::TriangleBuilder;

namespace {

constexpr double critical_z = 4.5;  // as docs/testing.md has it for means

/// The two squares of side 1 a distance apart that face each other; shapes 0 and 1.
SurfaceTriangles parallel_plates(float distance) {
    TriangleBuilder plates;
    plates.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 0);
    plates.quad({0, 1, distance}, {1, 1, distance}, {1, 0, distance}, {0, 0, distance}, 1);
    return plates.list();
}

/// Howell's catalogue, C-11: equal squares with X = Y = side / distance.
double plates_factor(double x) {
    const double s = std::sqrt(1.0 + x * x);
    return 2.0 / (pi * x * x) *
           (0.5 * std::log(sqr(float(1.0 + x * x)) / (1.0 + 2.0 * x * x)) + 2.0 * x * s * std::atan(x / s) -
            2.0 * x * std::atan(x));
}

struct CubeFactors {
    SeedMean opposite, adjacent, row, itself;
};

/// Over `seeds` seeds, of `directions` each; `pdf_error` scales the density of directions wrongly.
CubeFactors cube_factors(int seeds, std::uint32_t directions, double pdf_error = 1.0) {
    const SurfaceTriangles cube = TriangleBuilder().box(Vec3(0.0f), Vec3(1.0f), true).list();
    const BundleTracer tracer(cube);
    CubeFactors result;
    for (int seed = 1; seed <= seeds; ++seed) {
        const FormFactors f = form_factors(tracer, 6, 1.0f / 16.0f, std::uint64_t(seed), directions);
        double row = 0.0;
        for (std::uint32_t j = 0; j < 6; ++j) row += f.factor(0, j);
        result.opposite.add(f.factor(0, 1) * pdf_error);
        result.adjacent.add(f.factor(0, 2) * pdf_error);
        result.row.add(row * pdf_error), result.itself.add(f.factor(0, 0));
    }
    return result;
}

}  // namespace

TEST_CASE("form factors of the unit cube by bundles", "[ray_bundles][form_factors]") {
    const CubeFactors f = cube_factors(24, 400);
    INFO(f.opposite.mean() << " +- " << f.opposite.error() << ", " << f.adjacent.mean() << " +- "
                           << f.adjacent.error());
    CHECK(f.opposite.error() < 6e-4);
    CHECK(std::fabs(f.opposite.z(0.1998249)) < critical_z);
    CHECK(std::fabs(f.adjacent.z(0.2000438)) < critical_z);
    CHECK(std::fabs(f.row.z(1.0)) < critical_z);
    CHECK(f.itself.mean() == 0.0);
    // A density off by two per cent is found.
    const CubeFactors planted = cube_factors(24, 400, 1.02);
    CHECK(std::fabs(planted.opposite.z(0.1998249)) > critical_z);
    CHECK(std::fabs(planted.row.z(1.0)) > critical_z);
}

TEST_CASE("form factors of parallel plates by bundles", "[ray_bundles][form_factors]") {
    CHECK(std::fabs(plates_factor(1.0) - 0.1998249) < 1e-7);
    for (const float distance : {0.25f, 0.5f, 1.0f, 2.0f}) {
        const SurfaceTriangles plates = parallel_plates(distance);
        const BundleTracer tracer(plates);
        SeedMean there, back;
        for (std::uint64_t seed = 1; seed <= 32; ++seed) {
            const FormFactors f = form_factors(tracer, 2, 1.0f / 16.0f, seed, 200);
            there.add(f.factor(0, 1)), back.add(f.factor(1, 0));
        }
        const double expected = plates_factor(1.0 / double(distance));
        INFO(distance << " m: " << there.mean() << " +- " << there.error() << ", expected " << expected);
        CHECK(there.error() < 0.01 * expected);
        CHECK(std::fabs(there.z(expected)) < critical_z);
        CHECK(there.mean() == Approx(back.mean()).epsilon(1e-6));
        CHECK(std::fabs(there.z(1.05 * expected)) > critical_z);
    }
}

TEST_CASE("within a sphere every patch is seen by its area", "[ray_bundles][form_factors]") {
    const std::vector<std::shared_ptr<Shape>> shapes = {make_sphere(Vec3d(1, 2, 3), 2.0, Transform(), true)};
    SurfaceTriangles sphere = surface_triangles(shapes, {.chord_error = 2e-3f});
    double largest = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < sphere.size(); ++i) {
        const auto& c = sphere.corners[i];
        const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0f - Vec3(1, 2, 3);
        sphere.shape[i] = middle.z > 1.2f ? 0 : middle.x > 0.3f ? 1 : 2;
        const double area = 0.5 * double(glm::length(glm::cross(c[1] - c[0], c[2] - c[0])));
        whole += area, largest = std::max(largest, area);
    }
    const BundleTracer tracer(sphere);
    SeedMean factors[3][3];
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        const FormFactors f = form_factors(tracer, 3, 0.1f, seed, 32);
        for (std::uint32_t i = 0; i < 3; ++i)
            for (std::uint32_t j = 0; j < 3; ++j) factors[i][j].add(f.factor(i, j) - f.area(j) / whole);
    }
    // A flat triangle does not see itself, nor as much of its neighbours: that share is missing.
    const double flat = 4.0 * largest / whole;
    CHECK(flat < 0.01);
    for (const auto& row : factors)
        for (const SeedMean& difference : row)
            CHECK(std::fabs(difference.mean()) < flat + critical_z * difference.error());
    CHECK_FALSE(std::fabs(factors[0][1].mean() + 0.02) < flat + critical_z * factors[0][1].error());
}

TEST_CASE("the error falls faster than one over the root of the number of directions",
          "[ray_bundles][form_factors]") {
    const SurfaceTriangles cube = TriangleBuilder().box(Vec3(0.0f), Vec3(1.0f), true).list();
    const BundleTracer tracer(cube);
    constexpr int seeds = 48, steps = 6;
    double x[steps], y[steps], mean_x = 0.0, mean_y = 0.0;
    for (int i = 0; i < steps; ++i) {
        const std::uint32_t directions = 4u << i;
        double squares = 0.0;
        for (int seed = 1; seed <= seeds; ++seed) {
            const FormFactors f =
                form_factors(tracer, 6, 1.0f / 32.0f, std::uint64_t(100 * i + seed), directions);
            squares += (f.factor(0, 1) - 0.1998249) * (f.factor(0, 1) - 0.1998249);
        }
        x[i] = std::log(double(directions)), y[i] = 0.5 * std::log(squares / seeds);
        mean_x += x[i] / steps, mean_y += y[i] / steps;
    }
    double xy = 0.0, xx = 0.0;
    for (int i = 0; i < steps; ++i)
        xy += (x[i] - mean_x) * (y[i] - mean_y), xx += (x[i] - mean_x) * (x[i] - mean_x);
    const double exponent = xy / xx;
    // The logarithm of a root mean square of n normal errors has the deviation 1 / sqrt(2 n).
    const double deviation = std::sqrt(1.0 / (2.0 * seeds) / xx);
    INFO("error ~ N^" << exponent << " +- " << deviation);
    CHECK(exponent + critical_z * deviation < -0.5);
}
