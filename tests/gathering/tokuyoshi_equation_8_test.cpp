// Eq. 8 of Tokuyoshi & Ogaki 2012 as it is printed and as it should be (docs/errata.md), between two plates.
//
// A point light between an infinite floor and ceiling; x_3 on the floor. Two bounces: light falls on x_1 on
// the floor, goes to x_2 on the ceiling, and to x_3. The same light by cosine-distributed directions from x_3
// and from x_2, which takes none of the densities in question.
#include "core/math/random.h"
#include "core/math/warp.h"
#include "tests/media/statistics.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using mote::tests::Mean;

namespace {

constexpr float albedo = 0.6f, light_height = 0.4f;
const Vec3 light(0.0f, 0.0f, light_height), receiver(0.5f, 0.0f, 0.0f);
constexpr float f = albedo * inv_pi;

Vec3 on_ceiling(const Vec3& from, const Vec3& up) { return from + up * (1.0f / up.z); }
Vec3 on_floor(const Vec3& from, const Vec3& down) { return from + down * (from.z / -down.z); }

/// Irradiance of a light of intensity 1 on the floor.
float irradiance(const Vec3& x) {
    const float d2 = glm::dot(light - x, light - x);
    return light_height / (d2 * std::sqrt(d2));
}

float by_paths(Rng& rng) {
    const Vec3 x2 = on_ceiling(receiver, square_to_cosine_hemisphere(rng.next_vec2()));
    Vec3 down = square_to_cosine_hemisphere(rng.next_vec2());
    down.z = -down.z;
    return albedo * albedo * f * irradiance(on_floor(x2, down));
}

/// Eq. 7 over p_12 of Eq. 8, with the cosines at x_1 and x_2 towards each other, or as printed towards the
/// light and x_3.
float by_eq_7(Rng& rng, bool as_printed) {
    const Vec3 w0 = square_to_sphere(rng.next_vec2());  // p_e = 1 / (4 pi)
    Vec3 w3 = square_to_sphere(rng.next_vec2());
    w3.z = std::fabs(w3.z);  // p_r = 1 / (2 pi)
    if (!(w0.z < 0.0f) || !(w3.z > 0.0f)) return 0.0f;
    const Vec3 x1 = on_floor(light, w0), x2 = on_ceiling(receiver, w3);
    const float d2 = glm::dot(x2 - x1, x2 - x1),
                between = 1.0f / std::sqrt(d2);  // both cosines: the plates are 1 apart
    const float cosines = as_printed ? -w0.z * w3.z : between * between;
    return f * f * f * w3.z * cosines / (d2 * inv_four_pi * inv_two_pi);
}

}  // namespace

TEST_CASE("Eq. 8 needs the cosines of the edge between the two points, not those printed",
          "[bundles][errata]") {
    Rng rng(1);
    Mean paths, right, printed;
    for (int i = 0; i < 200000; ++i) {
        paths.add(double(by_paths(rng)));
        right.add(double(by_eq_7(rng, false)));
        printed.add(double(by_eq_7(rng, true)));
    }
    const auto sigmas = [&](const Mean& m) {
        return std::fabs(m.value() - paths.value()) / std::hypot(m.standard_error(), paths.standard_error());
    };
    CAPTURE(paths.value(), right.value(), printed.value());
    CHECK(sigmas(right) < 4.5);
    CHECK(sigmas(printed) > 10.0);
}
