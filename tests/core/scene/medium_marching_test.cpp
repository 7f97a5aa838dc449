// Optical depths by marching as any Medium has them: closed forms, steps, bounds, segments without end.
#include <cmath>

#include "core/scene/medium.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

/// Extinction 0, x and x^2 per channel between two planes; vacuum beyond.
class Ramp : public Medium {
  public:
    MediumTraits traits() const override {
        MediumTraits t;
        t.voxel_size = voxel_size, t.homogeneous = homogeneous;
        return t;
    }
    const PhaseFunction& phase() const override { throw std::logic_error("not requested"); }
    MediumCoefficients coefficients(const Vec3& p) const override {
        MediumCoefficients c;
        const float x = homogeneous ? 2.0f : p.x;
        c.sigma_t = bounds().contains(p) ? Rgb(0.0f, x, x * x) : Rgb(0.0f);
        return c;
    }
    float majorant() const override { return 9.0f; }
    Bounds3 bounds() const override { return {Vec3(1, -infinity, -infinity), Vec3(end, infinity, infinity)}; }
    std::optional<float> sample_collision(const Ray&, PathWeights&, Rgb&, Rng&,
                                          TrackingCounters&) const override {
        return std::nullopt;
    }
    void connect(const Ray&, PathWeights&, Rng&, TrackingCounters&) const override {}
    Rgb transmittance(const Ray&, Rng&, TrackingCounters&) const override { return Rgb(1.0f); }

    float voxel_size = infinity, end = 3.0f;
    bool homogeneous = false;
};

const Vec3 along(1, 0, 0);

}  // namespace

TEST_CASE("marching meets closed forms, whatever a medium says of its voxels", "[media][marching]") {
    Ramp ramp;
    for (const float voxel : {infinity, 0.01f}) {
        ramp.voxel_size = voxel;
        TrackingCounters counters;
        const Vec3d depth = ramp.optical_depth_along({Vec3(0), along, 0.0f, infinity}, 1.0f, counters);
        CHECK(depth.x == 0.0);
        CHECK(depth.y == Approx(4.0).epsilon(1e-6));         // the midpoint rule is exact for lines,
        CHECK(depth.z == Approx(26.0 / 3.0).epsilon(1e-4));  // and takes h^2 / 24 times the change of slope
        CHECK(counters.lookups > 0);
        std::vector<Vec3d> depths(5);
        ramp.optical_depths_along({Vec3(0), along, 0.5f, 3.5f}, 1.0f, depths, counters);
        for (int k = 0; k < 5; ++k) {
            const double to = std::clamp(0.5 + 0.6 * (k + 1), 1.0, 3.0);
            CHECK(depths[std::size_t(k)].y == Approx((to * to - 1.0) / 2.0).epsilon(1e-4));
        }
    }
    ramp.voxel_size = 0.5f;
    CHECK(ramp.marching_step(0.25f, 7.0f) == 0.125f);
    TrackingCounters counters;
    ramp.optical_depth_along({Vec3(0), along, 1.0f, 2.0f}, 0.25f, counters);
    CHECK(counters.lookups == 8);
    ramp.voxel_size = infinity;
    CHECK(ramp.marching_step(0.25f, 7.0f) == 7.0f / float(Medium::default_steps));
}

TEST_CASE("homogeneous media and segments without end are marched in one step", "[media][marching]") {
    Ramp ramp;
    ramp.homogeneous = true;
    TrackingCounters counters;
    CHECK(ramp.marching_step(1.0f, 1.0f) == infinity);
    CHECK(ramp.optical_depth_along({Vec3(0), along, 0.0f, 2.5f}, 1.0f, counters) == Vec3d(0.0, 3.0, 6.0));
    CHECK(counters.lookups == 0);
    ramp.end = infinity;
    for (const bool homogeneous : {true, false}) {
        ramp.homogeneous = homogeneous;
        const Vec3d depth = ramp.optical_depth_along({Vec3(0), along, 0.0f, infinity}, 1.0f, counters);
        CHECK(depth.x == 0.0);
        CHECK(depth.y == double(infinity));
    }
}
