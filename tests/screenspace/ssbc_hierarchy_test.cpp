// The sum over nodes against the sum over all pixels, and what half resolution and the blur change.
//
// Approximations are held against the error that the picture has anyway: that of light which is constant over
// a pixel, found by a picture of half the size (grid_convergence.h).
#include <tbb/global_control.h>

#include "screenspace/ssbc/ssbc.h"
#include "screenspace/ssbc/ssbc_blur.h"
#include "tests/screenspace/ssbc_room.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

const float room_bound = 1.0f;  // radius: half the width of the room, so that levels have something to save

SsbcSettings flat_settings() {
    SsbcSettings s;
    s.bound = room_bound, s.steps = 1, s.hierarchical = false;
    return s;
}

struct Room {
    TestPicture picture = room(96);
    SsbcResult flat = compensate(picture.surfaces, picture.light, flat_settings());

    SsbcResult run(const std::function<void(SsbcSettings&)>& change) const {
        SsbcSettings s = flat_settings();
        s.hierarchical = true;
        change(s);
        return compensate(picture.surfaces, picture.light, s);
    }
    /// Root of the summed squares of the difference to the flat sum over that of the flat sum.
    double error(const SsbcResult& result) const {
        double error = 0.0, all = 0.0;
        for (std::size_t i = 0; i < flat.compensation.size(); ++i) {
            const Vec3d exact(flat.compensation[i]), d = Vec3d(result.compensation[i]) - exact;
            error += glm::dot(d, d), all += glm::dot(exact, exact);
        }
        return std::sqrt(error / all);
    }
};

const Room& test_room() {
    static const Room room;
    return room;
}

/// The error of the flat sum itself, of first order in the pixels' size: its difference to that of half the
/// size, over squares of four pixels that show one wall.
double resolution_error() {
    const Room& fine = test_room();
    const TestPicture coarse = room(48);
    const SsbcResult flat = compensate(coarse.surfaces, coarse.light, flat_settings());
    double error = 0.0, all = 0.0;
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 48; ++x) {
            const std::size_t here = coarse.index(x, y);
            Vec3d mean(0.0);
            bool same = true;
            for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
                const std::size_t i = fine.picture.index(2 * x + dx, 2 * y + dy);
                mean += 0.25 * Vec3d(fine.flat.compensation[i]);
                same = same && fine.picture.wall[i] == coarse.wall[here];
            }
            if (!same) continue;
            const Vec3d d = Vec3d(flat.compensation[here]) - mean;
            error += glm::dot(d, d), all += glm::dot(mean, mean);
        }
    return std::sqrt(error / all);
}

double samples(const SsbcResult& r) { return double(r.counts.samples) / double(r.counts.receivers); }

}  // namespace

TEST_CASE("A hierarchy of pixels alone is the flat sum", "[ssbc][hierarchy]") {
    const Room& room = test_room();
    const SsbcResult pixels = room.run([](SsbcSettings& s) { s.refinement.levels = 1; });
    CHECK(room.error(pixels) < 1e-5);  // sums in single precision, in another order
    const SsbcResult refined = room.run([](SsbcSettings& s) {
        s.refinement.splits = 0, s.refinement.projected_angle = 0,
        s.refinement.discontinuity_projected_angle = 0;
    });
    SsbcSettings s = flat_settings();
    s.refinement.splits = 0;
    const SsbcResult unsplit = compensate(room.picture.surfaces, room.picture.light, s);
    for (std::size_t i = 0; i < unsplit.compensation.size(); ++i)
        CHECK(refined.compensation[i].y == Approx(unsplit.compensation[i].y).epsilon(1e-4).margin(1e-7));
}

TEST_CASE("Fewer samples with every level, fewer errors with every threshold", "[ssbc][hierarchy]") {
    const Room& room = test_room();
    double before = infinity;
    const double resolution = resolution_error();
    for (const int levels : {1, 2, 3, 6}) {
        const SsbcResult r = room.run([&](SsbcSettings& s) { s.refinement.levels = levels; });
        INFO(levels << " levels: " << samples(r) << " samples, error " << room.error(r) << ", resolution "
                    << resolution);
        CHECK(samples(r) < before + 1.0);         // a level that changes nothing may skip a little less
        CHECK(room.error(r) < 0.1 * resolution);  // adds a hundredth to the squared error
        before = samples(r);
    }
    const SsbcResult one = room.run([](SsbcSettings& s) { s.refinement.levels = 1; });
    CHECK(before < samples(one));
    double error = 0.0, count = infinity;
    for (const float angle : {0.01f, 0.04f, 0.16f, 0.64f}) {
        const SsbcResult r = room.run([&](SsbcSettings& s) {
            // Patches as fine as in the flat sum: the error is that of the nodes.
            s.refinement.projected_angle = angle, s.refinement.discontinuity_projected_angle = 0.5f * angle;
            s.refinement.splits = 0;
        });
        SsbcSettings f = flat_settings();
        f.refinement.splits = 0;
        const Room unsplit{room.picture, compensate(room.picture.surfaces, room.picture.light, f)};
        INFO(angle << " sr: " << samples(r) << " samples, error " << unsplit.error(r));
        CHECK(samples(r) <= count);
        CHECK(unsplit.error(r) >= error);
        error = unsplit.error(r), count = samples(r);
    }
    CHECK(error > 0.1 * resolution);  // the thresholds matter
}

TEST_CASE("Angles of mean positions and normals miss most of the light", "[ssbc][hierarchy][planted]") {
    const Room& room = test_room();
    const SsbcResult at_mean =
        room.run([](SsbcSettings& s) { s.refinement.estimate = RefinementRules::Estimate::at_mean; });
    const SsbcResult at_most = room.run([](SsbcSettings&) {});
    INFO("at mean " << room.error(at_mean) << ", at most " << room.error(at_most));
    CHECK(room.error(at_most) < 0.1 * resolution_error());
    CHECK(room.error(at_mean) > 0.5);
}

TEST_CASE("Half resolution is near, because defective pixels are evaluated again", "[ssbc][upsampling]") {
    const Room& room = test_room();
    const SsbcResult half = room.run([](SsbcSettings& s) { s.half_resolution = true; });
    INFO("error " << room.error(half) << ", " << half.defective << " defective of " << half.counts.receivers);
    CHECK(room.error(half) < resolution_error());
    CHECK(half.defective > 0);
    CHECK(half.counts.receivers < room.flat.counts.receivers);
    const SsbcResult careless = room.run([](SsbcSettings& s) {
        s.half_resolution = true;
        s.upsampling.contrast = infinity, s.upsampling.min_weight = 0.0f;
    });
    CHECK(room.error(careless) > 2.0 * room.error(half));
}

TEST_CASE("A blur keeps to its surface and changes nothing that is even", "[ssbc][blur]") {
    const Room& room = test_room();
    const SsbcSurfaces& surfaces = room.picture.surfaces;
    std::vector<Rgb> walls(surfaces.pixel_count());
    for (std::size_t i = 0; i < walls.size(); ++i) walls[i] = Rgb(float(room.picture.wall[i]));
    const auto even = blurred(surfaces, walls, 2.0f, 0.35f);
    for (std::size_t i = 0; i < walls.size(); ++i)
        CHECK(even[i].x == Approx(walls[i].x).epsilon(1e-4).margin(1e-4));
    const auto wide = blurred(surfaces, walls, 2.0f, 0.5f * pi);  // an angle that distinguishes no surfaces
    double mixed = 0.0;
    for (std::size_t i = 0; i < walls.size(); ++i) mixed += double(std::abs(wide[i].x - walls[i].x));
    CHECK(mixed > 1.0);
}

TEST_CASE("The number of threads changes no bit", "[ssbc]") {
    const Room& room = test_room();
    const auto run = [&] {
        return room.run([](SsbcSettings& s) { s.half_resolution = true, s.steps = 2, s.blur = 1.0f; });
    };
    const SsbcResult many = run();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const SsbcResult single = run();
    CHECK(many.compensation == single.compensation);
    CHECK(many.counts.samples == single.counts.samples);
}
