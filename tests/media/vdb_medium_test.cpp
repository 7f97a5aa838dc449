// Tracking through VDB grids: against closed forms and quadrature, under any linear transform.
#include <array>

#include "core/objects/error.h"
#include "media/nano_grid.h"
#include "media/vdb_volume.h"
#include "tests/media/test_media.h"
#include "tests/media/tools/test_density.h"
#include "tests/media/vdb_test_files.h"
#include "tests/support/catch.h"
#include "tests/support/test_data.h"

using namespace mote;
using core::Ray, core::Rgb, core::Transform, core::Vec3, core::Vec3d;

namespace {

std::shared_ptr<media::HeterogeneousMedium> vdb_medium(const std::string& path, float scale,
                                                       const Rgb& albedo, const Transform& to_world = {}) {
    return media::VdbVolume(media::load_vdb_grid(path), to_world)
        .make_medium(tests::medium_parts(albedo, scale));
}

Ray between(const Vec3d& a, const Vec3d& b) {
    const Vec3 from(a), to(b);
    return {from, glm::normalize(to - from), 0.0f, glm::distance(from, to)};
}

double depth_between(const media::HeterogeneousMedium& m, const Vec3d& a, const Vec3d& b) {
    core::TrackingCounters counters;
    const Ray ray = between(a, b);
    return m.optical_depth_by_marching(ray, ray.t_max / 20000.0f, counters).x;
}

}  // namespace

TEST_CASE("a VDB of constant density is the homogeneous medium", "[media][vdb][tracking]") {
    const tests::GridFolder folder;
    const Rgb albedo(0.8f);
    const auto m = vdb_medium(folder.grid("tiles"), 0.1f, albedo);  // 0.75 from voxel -4 to 35
    const Ray inside = between(Vec3d(0, 1, 3), Vec3d(30, 28, 33));
    const Vec3d tau(0.075 * double(inside.t_max));
    CHECK(tests::worst_sigmas(tests::spectral_estimates(*m, inside, 50000, 1), tau, albedo) < 5.0);
    core::Rng rng(1);
    core::TrackingCounters counters;
    // a cell away from the border every cell is constant, and residual tracking leaves nothing random
    const Ray deep = between(Vec3d(4, 5, 6), Vec3d(30, 28, 33));
    const double deep_depth = 0.075 * double(deep.t_max);
    CHECK(m->transmittance(deep, rng, counters).x == Approx(std::exp(-deep_depth)).epsilon(1e-5));
    CHECK(m->optical_depth_by_marching(inside, 0.01f, counters).x == Approx(tau.x).epsilon(1e-5));
    // through all of it: 39 voxels of full density, and half a voxel's worth at each end
    const Ray through{Vec3(15, 15, -100), Vec3(0, 0, 1), 0.0f, core::infinity};
    CHECK(m->optical_depth_by_marching(through, 0.001f, counters).x == Approx(0.075 * 40.0).epsilon(1e-4));
    CHECK(m->bounds().lower.x == Approx(-5.0));
    CHECK(m->bounds().upper.z == Approx(36.0));
    CHECK_FALSE(m->traits().chromatic);
    CHECK(m->traits().description.find("40x40x40") != std::string::npos);
}

TEST_CASE("optical depth does not depend on how a grid is placed", "[media][vdb][transforms]") {
    const tests::GridFolder folder;
    const auto reference = vdb_medium(folder.grid("lump"), 1.0f, Rgb(0.5f));
    const Vec3d a(-3.0, 2.5, 4.0), b(27.0, 19.0, 21.5);  // in index space
    const double tau = depth_between(*reference, a, b) / glm::distance(a, b);
    REQUIRE(tau * glm::distance(a, b) > 5.0);

    const auto rotation = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(Vec3d(1, 2, 3)));
    glm::dmat4 shear(1.0);
    shear[1][0] = 0.6, shear[2][1] = -0.3;
    const auto scaled = [](double s) { return glm::scale(glm::dmat4(1.0), Vec3d(s)); };
    struct Placing {
        const char* name;
        glm::dmat4 in_file, in_scene;
    };
    const std::array<Placing, 9> placings = {{
        {"rotated", rotation, glm::dmat4(1.0)},
        {"sheared", shear, rotation},
        {"mirrored", glm::scale(glm::dmat4(1.0), Vec3d(-1, 1, 1)),
         glm::translate(glm::dmat4(1.0), Vec3d(5, 6, 7))},
        {"mirrored in the scene", rotation, glm::scale(glm::dmat4(1.0), Vec3d(1, 1, -2))},
        {"anisotropic", glm::scale(glm::dmat4(1.0), Vec3d(0.1, 0.2, 3.0)), shear},
        {"voxels of 2e-5", scaled(2e-5), glm::dmat4(1.0)},
        {"voxels of 1e-6", scaled(1e-3), scaled(1e-3)},
        {"voxels of 1e6", scaled(1e6), glm::dmat4(1.0)},
        {"far away", glm::dmat4(1.0), glm::translate(glm::dmat4(1.0), Vec3d(3e3, -2e3, 1e3))},
    }};
    for (const Placing& p : placings) {
        INFO(p.name);
        const Transform in_file(p.in_file), in_scene(p.in_scene);
        const std::string path = folder.grid("lump", &in_file);
        const Transform all = in_scene * in_file;
        const Vec3d from = all.point(a), to = all.point(b);
        const float scale = float(1.0 / glm::distance(from, to));
        const auto m = vdb_medium(path, scale, Rgb(0.5f), in_scene);
        CHECK(depth_between(*m, from, to) == Approx(tau).epsilon(1e-4));
        // and the random estimators see the same medium
        const double t = std::exp(-tau);
        core::Rng rng(9);
        core::TrackingCounters counters;
        tests::Mean passed, estimate;
        for (int i = 0; i < 5000; ++i) {
            core::PathWeights w;
            w.light = core::Rgb(1.0f);  // as after a scattering of density 1
            Rgb emitted(0.0f);
            passed.add(!m->sample_collision(between(from, to), w, emitted, rng, counters));
            estimate.add(m->transmittance(between(from, to), rng, counters).x);
        }
        CHECK(passed.sigmas_from(t, 1e-4) < 5.0);
        CHECK(estimate.sigmas_from(t, 1e-4) < 5.0);
        CHECK(counters.fallbacks == 0);
    }
}

TEST_CASE("singular placings are refused", "[media][vdb][transforms]") {
    const tests::GridFolder folder;
    const auto grid = media::load_vdb_grid(folder.grid("lump"));
    const Transform flat(glm::scale(glm::dmat4(1.0), Vec3d(1, 0, 1)));
    CHECK_THROWS_AS(media::VdbVolume(grid, flat), core::InputError);
    Transform broken;
    broken.matrix[0][0] = std::nan("");
    CHECK_THROWS_AS(media::VdbVolume(grid, broken), core::InputError);
}

TEST_CASE("VDB majorants bound every lookup", "[media][vdb]") {
    const tests::GridFolder folder;
    for (const char* kind : {"lump", "tiles", "single", "step", "background"}) {
        const auto grid = media::load_vdb_grid(folder.grid(kind));
        const auto majorants = media::nano_majorants(*grid);
        media::NanoCursor cursor(*grid);
        core::Rng rng(8);
        INFO(kind);
        CHECK(majorants.total().upper == grid->max_value());
        const Vec3d centre = 0.5 * Vec3d(grid->lower() + grid->upper());
        for (int i = 0; i < 3000; ++i) {
            const Vec3d o =
                centre + 40.0 * (Vec3d(rng.next_float(), rng.next_float(), rng.next_float()) - 0.5);
            const Vec3d d =
                centre + 20.0 * (Vec3d(rng.next_float(), rng.next_float(), rng.next_float()) - 0.5) - o;
            double covered = 0.0;
            majorants.walk(o, d, -3.0, 4.0, [&](const auto& range, double t0, double t1) {
                covered += t1 - t0;
                for (const double f : {0.01, 0.5, 0.99}) {
                    const float v = cursor.lookup(o + (t0 + f * (t1 - t0)) * d);
                    REQUIRE(v <= range.upper * 1.000001f);
                    REQUIRE(v >= range.lower * 0.999999f);
                }
                return true;
            });
            if (grid->background() > 0.0f) REQUIRE(covered == Approx(7.0));
        }
    }
}

TEST_CASE("an empty grid is vacuum", "[media][vdb]") {
    const tests::GridFolder folder;
    const auto m = vdb_medium(folder.grid("empty"), 5.0f, Rgb(0.5f));
    CHECK(m->traits().empty);
    CHECK(m->bounds().empty());
    core::Rng rng(1);
    core::TrackingCounters counters;
    const Ray ray{Vec3(0), Vec3(1, 0, 0), 0.0f, core::infinity};
    CHECK(m->transmittance(ray, rng, counters) == Rgb(1.0f));
    core::PathWeights w;
    w.light = core::Rgb(1.0f);  // as after a scattering of density 1
    Rgb emitted(0.0f);
    CHECK_FALSE(m->sample_collision(ray, w, emitted, rng, counters));
    CHECK(w.throughput == Rgb(1.0f));
    CHECK(m->optical_depth_by_marching(ray, 0.1f, counters) == Vec3d(0.0));
}

TEST_CASE("a medium without bounds around a grid with a background", "[media][vdb]") {
    const tests::GridFolder folder;
    const Rgb albedo(0.7f);
    const auto m = vdb_medium(folder.grid("background"), 0.05f, albedo);
    const Ray ray = between(Vec3d(-20, 8, 9), Vec3d(50, 13, 12));
    const Vec3d tau = tests::quadrature_depth(*m, ray, ray.t_max, 20000);
    CHECK(tests::worst_sigmas(tests::spectral_estimates(*m, ray, 40000, 6), tau, albedo, 1e-5) < 5.0);
    CHECK(m->bounds().upper.x == core::infinity);
}

TEST_CASE("real smoke: every estimator agrees with quadrature", "[media][vdb][data]") {
    const Rgb albedo(0.9f);
    for (const char* name : {"vdb/openusd/smoke_000002.vdb", "vdb/openusd/densityAndHeat.vdb",
                             "vdb/gaffer/GafferVDBTest/data/smoke.vdb"}) {
        const auto path = tests::test_data(name);
        if (!path) continue;
        const media::VdbVolume volume(media::load_vdb_grid(*path));
        auto parts = tests::medium_parts(albedo, 1.0f);
        const auto probe = volume.make_medium(parts);
        const core::Bounds3 box = probe->bounds();
        // a scale that gives a ray through the middle an optical depth of about 2
        core::TrackingCounters counters;
        const Vec3 from = glm::mix(box.lower, box.upper, Vec3(0.1f, 0.4f, 0.3f)),
                   to = glm::mix(box.lower, box.upper, Vec3(0.9f, 0.55f, 0.6f));
        const Ray ray = between(Vec3d(from), Vec3d(to));
        const double unit = probe->optical_depth_by_marching(ray, ray.t_max / 50000, counters).x;
        INFO(name << " " << probe->traits().description);
        REQUIRE(unit > 0.0);
        parts.scale = float(2.0 / unit);
        const auto m = volume.make_medium(parts);
        const auto e = tests::spectral_estimates(*m, ray, 100000, 13);
        CHECK(tests::worst_sigmas(e, Vec3d(unit * parts.scale), albedo, 1e-4) < 5.0);
        // planted: a two per cent error of the optical depth must not pass
        CHECK(tests::worst_sigmas(e, Vec3d(unit * parts.scale * 1.02), albedo, 1e-4) > 5.0);
        CHECK(e.counters.fallbacks == 0);
    }
}

TEST_CASE("emission and temperature of a VDB", "[media][vdb][emission]") {
    const tests::GridFolder folder;
    auto parts = tests::medium_parts(Rgb(0.0f), 0.02f);
    parts.emission.radiance = std::make_shared<media::ConstantVolume>(Rgb(3.0f));
    const auto m = media::VdbVolume(media::load_vdb_grid(folder.grid("lump"))).make_medium(parts);
    const Ray ray = between(Vec3d(0, 11, 12), Vec3d(24, 12, 11));
    const double tau = tests::quadrature_depth(*m, ray, ray.t_max, 20000).x;
    const auto e = tests::spectral_estimates(*m, ray, 40000, 6);
    CHECK(e.emitted[1].sigmas_from(3.0 * -std::expm1(-tau)) < 5.0);
}
