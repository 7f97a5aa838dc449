// Frames and boxes: orthonormal for every normal, intersected for every direction.
#include "core/math/frame.h"

#include "core/math/bounds.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

/// Largest deviation from an orthonormal right-handed frame.
float defect(const Frame& f) {
    const float lengths =
        std::fmax(std::fabs(glm::dot(f.s, f.s) - 1.0f), std::fabs(glm::dot(f.t, f.t) - 1.0f));
    const float angles = std::fmax(std::fabs(glm::dot(f.s, f.t)),
                                   std::fmax(std::fabs(glm::dot(f.s, f.n)), std::fabs(glm::dot(f.t, f.n))));
    return std::fmax(std::fmax(lengths, angles), glm::length(glm::cross(f.s, f.t) - f.n));
}

}  // namespace

TEST_CASE("frames are orthonormal around any normal", "[math][frame]") {
    Rng rng(1);
    float worst = 0.0f, round_trip = 0.0f;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 n = glm::normalize(square_to_sphere(rng.next_vec2()));
        const Frame frame(n);
        worst = std::fmax(worst, defect(frame));
        const Vec3 w = square_to_sphere(rng.next_vec2());
        round_trip = std::fmax(round_trip, glm::length(frame.to_world(frame.to_local(w)) - w));
    }
    CHECK(worst < 2e-6f);  // a few roundings of values up to 2
    CHECK(round_trip < 4e-6f);
    for (const Vec3& n : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(0, 0, -0.0f) + Vec3(1, 0, 0), Vec3(0, -1, 0)})
        CHECK(defect(Frame(n)) < 1e-6f);
    // Just off the pole where older constructions break down.
    for (const float e : {1e-3f, 1e-4f, 1e-6f, 1e-20f})
        CHECK(defect(Frame(glm::normalize(Vec3(e, -e, -1.0f)))) < 2e-6f);
}

TEST_CASE("trigonometry in the local frame", "[math][frame]") {
    const Vec3 w = glm::normalize(Vec3(1, 2, -2));
    CHECK(cos_theta(w) == Approx(-2.0 / 3.0));
    CHECK(sin2_theta(w) == Approx(5.0 / 9.0));
    CHECK(tan2_theta(w) == Approx(5.0 / 4.0));
    CHECK_FALSE(same_hemisphere(w, {0, 0, 1}));
    CHECK(reflect_local(w).z == w.z);
    CHECK(reflect_local(w).x == -w.x);
}

TEST_CASE("boxes and rays", "[math][bounds]") {
    Bounds3 box;
    CHECK(box.empty());
    CHECK(box.radius() == 0.0f);
    box.extend(Vec3(-1, -2, -3));
    CHECK_FALSE(box.empty());
    box.extend(Vec3(1, 2, 3));
    CHECK(box.center() == Vec3(0, 0, 0));
    CHECK(box.radius() == Approx(std::sqrt(14.0)));
    CHECK(box.contains({1, 2, 3}));
    CHECK_FALSE(box.contains({1.01f, 0, 0}));

    Ray r;
    r.origin = {-5, 0, 0}, r.direction = {1, 0, 0};
    const auto through = intersect(box, r);
    REQUIRE(through);
    CHECK(through->t0 == 4.0f);
    CHECK(through->t1 == 6.0f);
    r.t_max = 5.0f;
    CHECK(intersect(box, r)->t1 == 5.0f);
    r.t_max = 3.0f;
    CHECK_FALSE(intersect(box, r));
    r.origin = {0, 0, 0}, r.t_max = infinity;
    CHECK(intersect(box, r)->t0 == 0.0f);
    r.origin = {-5, 3, 0};
    CHECK_FALSE(intersect(box, r));  // parallel, beside the box
    r.origin = {-5, 2, 0};
    CHECK(intersect(box, r));  // along a face
    CHECK_FALSE(intersect(Bounds3(), r));
    // Against marching in small steps, for random rays.
    Rng rng(2);
    int wrong = 0;
    for (int i = 0; i < 2000; ++i) {
        r.origin = 5.0f * square_to_sphere(rng.next_vec2());
        r.direction = square_to_sphere(rng.next_vec2());
        const auto part = intersect(box, r);
        for (float t = 0.005f; t < 10.0f; t += 0.1f) {
            const bool near_border =
                part && (std::fabs(t - part->t0) < 1e-3f || std::fabs(t - part->t1) < 1e-3f);
            const bool inside = part && t > part->t0 && t < part->t1;
            wrong += !near_border && inside != box.contains(r.at(t)) &&
                     max_component(glm::abs(r.at(t)) - box.upper) < -1e-3f;
        }
    }
    CHECK(wrong == 0);
}
