// Dense grids beyond their voxels: wrap modes as in Mitsuba 3, and the box that a medium ends at.
#include <cmath>

#include "tests/media/test_media.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using media::GridVolume, media::TransmittanceEstimator, media::WrapMode;

namespace {

constexpr WrapMode modes[] = {WrapMode::clamp, WrapMode::repeat, WrapMode::mirror};

/// Turned about an oblique axis, and stretched.
Transform turned() {
    const glm::dmat4 m = glm::rotate(glm::dmat4(1.0), 0.6, Vec3d(1.0, 2.0, -0.5));
    return Transform(glm::scale(glm::translate(m, Vec3d(0.3, -0.2, 0.1)), Vec3d(1.0, 0.7, 1.4)));
}

/// The box around the transformed unit cube, by its corners.
Bounds3 box_of(const Transform& to_world) {
    Bounds3 box;
    for (int i = 0; i < 8; ++i)
        box.extend(Vec3(to_world.point(Vec3d(double(i & 1), double(i >> 1 & 1), double(i >> 2)))));
    return box;
}

/// Optical depth of the volume inside the box, by the midpoint rule.
Vec3d quadrature(const GridVolume& volume, const Bounds3& box, const Ray& ray) {
    const auto part = intersect(box, ray);
    if (!part) return Vec3d(0.0);
    const int steps = 20000;
    const double h = (double(part->t1) - double(part->t0)) / steps;
    Vec3d sum(0.0);
    for (int i = 0; i < steps; ++i) sum += Vec3d(volume.eval(ray.at(float(part->t0 + (i + 0.5) * h))));
    return sum * h;
}

Ray ray_through(const Bounds3& box, Rng& rng) {
    const auto point = [&] {
        return box.lower +
               (1.6f * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 0.3f) * box.diagonal();
    };
    const Vec3 from = point(), direction = glm::normalize(point() - from);
    return {from - 2.0f * direction, direction, 0.0f, 6.0f};
}

}  // namespace

TEST_CASE("grids continue by clamping, repeating or mirroring", "[media][vol][wrap]") {
    const auto file = tests::vol_grid({3, 1, 1}, 1, [](int x, int, int) { return Rgb(float(1 << x)); });
    // Voxels -4 to 6 by each rule.
    const float expected[3][11] = {{1, 1, 1, 1, 1, 2, 4, 4, 4, 4, 4},
                                   {4, 1, 2, 4, 1, 2, 4, 1, 2, 4, 1},
                                   {4, 4, 2, 1, 1, 2, 4, 4, 2, 1, 1}};
    for (const WrapMode mode : modes) {
        const GridVolume volume(file, {}, false, "x", mode);
        const float* values = expected[int(mode)];
        for (int i = 0; i < 10; ++i) {
            INFO("mode " << int(mode) << ", voxel " << i - 4);
            const auto at = [&](float voxel) {
                return volume.eval(Vec3((voxel + 0.5f) / 3.0f, 7.3f, -2.0f)).x;
            };
            CHECK(at(float(i - 4)) == Approx(values[i]).margin(1e-5));
            CHECK(at(float(i - 4) + 0.25f) == Approx(0.75f * values[i] + 0.25f * values[i + 1]).margin(1e-5));
        }
        CHECK(std::isfinite(volume.eval(Vec3(1e30f, -1e30f, infinity)).x));
    }
}

TEST_CASE("a grid's medium ends at its box, in every wrap mode and however it is turned",
          "[media][vol][wrap]") {
    for (const WrapMode mode : modes)
        for (const int channels : {1, 3})
            for (const Transform& to_world : {Transform(), turned()}) {
                // The border is dense, so that what continues beyond it would be seen.
                const GridVolume volume(tests::vol_grid({5, 7, 6}, channels,
                                                        [rng = Rng(8)](int, int, int) mutable {
                                                            return Rgb(rng.next_float(), 1.0f, 0.5f);
                                                        }),
                                        to_world, false, "x", mode);
                const auto m = volume.make_medium(tests::medium_parts(Rgb(0.5f)));
                const Bounds3 box = box_of(to_world);
                CHECK(glm::distance(m->bounds().lower, box.lower) < 1e-6f);
                CHECK(glm::distance(m->bounds().upper, box.upper) < 1e-6f);
                Rng rng(2);
                TrackingCounters counters;
                for (int i = 0; i < 12; ++i) {
                    const Ray ray = ray_through(box, rng);
                    const Vec3d tau = quadrature(volume, box, ray);
                    INFO("mode " << int(mode) << ", " << channels << " channels, ray " << i << ", depth "
                                 << tau.x);
                    CHECK(glm::distance(m->optical_depth_along(ray, 1e-3f, counters), tau) < 2e-5);
                    std::vector<Vec3d> depths(7);
                    m->optical_depths_along(ray, 0.02f, depths, counters);
                    CHECK(glm::distance(depths.back(), tau) < 1e-3);
                    for (const auto estimator :
                         {TransmittanceEstimator::ray_marching, TransmittanceEstimator::delta_tracking,
                          TransmittanceEstimator::ratio_tracking,
                          TransmittanceEstimator::residual_ratio_tracking,
                          TransmittanceEstimator::unbiased_ray_marching}) {
                        tests::Mean mean;
                        for (int n = 0; n < 3000; ++n)
                            mean.add(m->transmittance_by(estimator, ray, rng, counters).x);
                        CHECK(mean.sigmas_from(std::exp(-tau.x), 2e-3) < 5.0);
                    }
                    const Vec3 beyond = ray.at(0.0f);
                    if (!box.contains(beyond)) CHECK(m->coefficients(beyond).sigma_t == Rgb(0.0f));
                }
            }
}

TEST_CASE("majorants hold beyond the voxels in every wrap mode", "[media][vol][wrap]") {
    const auto file = tests::random_grid({9, 5, 12}, 1, 3);
    for (const WrapMode mode : modes) {
        const media::DenseVoxels voxels{file.resolution, 1, file.values, mode};
        const auto majorants = media::dense_majorants<float>(voxels);
        Rng rng(6);
        const auto coordinate = [&] { return 40.0 * double(rng.next_float()) - 12.0; };
        for (int i = 0; i < 3000; ++i) {
            const Vec3d o(coordinate(), coordinate(), coordinate());
            const Vec3d d = Vec3d(coordinate(), coordinate(), coordinate()) - o;
            majorants.walk(o, d, 0.0, 1.0, [&](const auto& range, double t0, double t1) {
                for (const double f : {0.0, 0.3, 0.9, 1.0}) {
                    const float v = voxels.interpolate<float>(o + (t0 + f * (t1 - t0)) * d);
                    REQUIRE(v <= range.upper * 1.000001f);
                    REQUIRE(v >= range.lower * 0.999999f);
                }
                return true;
            });
        }
    }
}
