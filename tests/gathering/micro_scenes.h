// Surfaces of points, receivers, and closed forms for micro-buffers.
#pragma once

#include "core/geometry/analytic_shapes.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "gathering/micro_buffers/micro_buffers.h"
#include "tests/gathering/bundle_scenes.h"

namespace mote::tests {

/// The inside of a sphere around (1, 2, 3), of radius 2.
inline gathering::Surfels sphere_of_points(std::uint32_t count) {
    const std::vector<std::shared_ptr<core::Shape>> shapes = {
        core::make_sphere(core::Vec3d(1, 2, 3), 2.0, core::Transform(), true)};
    return gathering::blue_noise_surfels(gathering::surface_triangles(shapes, {.chord_error = 1e-3f}), count);
}

/// `normal` with the other two axes turned at random.
inline core::Frame turned_frame(const core::Vec3& normal, core::Rng& rng) {
    const core::Frame f(normal);
    const float angle = 2.0f * core::pi * rng.next_float();
    return {normal, std::cos(angle) * f.s + std::sin(angle) * f.t};
}

/// Anywhere within the ball around (1, 2, 3), looking anywhere.
inline std::vector<gathering::MicroReceiver> receivers_in_sphere(int count, float radius,
                                                                 std::uint64_t seed) {
    std::vector<gathering::MicroReceiver> receivers;
    core::Rng rng(seed);
    for (int i = 0; i < count; ++i) {
        const float r = radius * std::cbrt(rng.next_float());
        const core::Vec3 off = r * core::square_to_sphere(rng.next_vec2());
        const core::Vec3 normal = core::square_to_sphere(rng.next_vec2());
        receivers.push_back({core::Vec3(1, 2, 3) + off, turned_frame(normal, rng)});
    }
    return receivers;
}

/// Form factor from an element at height `h` below a parallel rectangle, [x0, x1] x [y0, y1] from its foot
/// (Howell's catalogue, B-3, over four corners).
inline double element_to_rectangle(double x0, double x1, double y0, double y1, double h) {
    const auto corner = [h](double x, double y) {
        const double a = x / h, b = y / h, p = std::sqrt(1.0 + a * a), q = std::sqrt(1.0 + b * b);
        return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2.0 * M_PI);
    };
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

/// Slope of log y over log x.
inline double exponent(std::span<const double> x, std::span<const double> y) {
    const double n = double(x.size());
    double sx = 0.0, sy = 0.0, sxy = 0.0, sxx = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double a = std::log(x[i]), b = std::log(y[i]);
        sx += a, sy += b, sxy += a * b, sxx += a * a;
    }
    return (sxy - sx * sy / n) / (sxx - sx * sx / n);
}

}  // namespace mote::tests
