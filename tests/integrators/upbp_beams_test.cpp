// Crossings of query beams and light beams: in closed form for one pair, and all pairs of many.
#include <algorithm>
#include <numbers>

#include "core/math/random.h"
#include "integrators/upbp/light_beams.h"
#include "media/homogeneous_medium.h"
#include "media/phase_functions.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::integrators;

namespace {

Vec3d unit_vector(Rng& rng) {
    const double z = 2.0 * double(rng.next_float()) - 1.0, a = 2.0 * std::numbers::pi * rng.next_float();
    const double s = std::sqrt(1.0 - z * z);
    return {s * std::cos(a), s * std::sin(a), z};
}
Vec3d in_cube(Rng& rng) { return 2.0 * Vec3d(rng.next_float(), rng.next_float(), rng.next_float()) - 1.0; }

/// Beams in a fog without bounds, one of each light subpath.
std::vector<std::vector<LightBeam>> random_beams(int count, const Medium& fog, Rng& rng) {
    std::vector<std::vector<LightBeam>> rows(2);
    for (int i = 0; i < count; ++i) {
        LightBeam b;
        b.beam.ray = {Vec3(in_cube(rng)), Vec3(unit_vector(rng)), 0.0f, 3.0f};
        b.beam.reached = 3.0f * rng.next_float();
        b.beam.state.set_outside(&fog);
        rows[std::size_t(i) % 2].push_back(b);
    }
    return rows;
}

}  // namespace

TEST_CASE("two lines are nearest where they were made to be", "[upbp][beams]") {
    Rng rng(7);
    for (int i = 0; i < 200; ++i) {
        const Vec3d u = unit_vector(rng), n = glm::normalize(glm::cross(u, unit_vector(rng)));
        const double angle = std::numbers::pi * (0.05 + 0.9 * double(rng.next_float()));
        const Vec3d v = std::cos(angle) * u + std::sin(angle) * glm::cross(n, u), from = in_cube(rng);
        const double t = in_cube(rng).x, s = in_cube(rng).x, apart = double(rng.next_float());
        const auto c = crossing_of({Vec3(from), Vec3(u)}, {Vec3(from + t * u + apart * n - s * v), Vec3(v)});
        REQUIRE(c);
        // Rounding of directions, which small angles magnify.
        const double tolerance = 2e-6 / std::sin(angle);
        CHECK(std::fabs(c->t - t) < tolerance);
        CHECK(std::fabs(c->s - s) < tolerance);
        CHECK(std::fabs(c->apart - apart) < tolerance);
        CHECK(std::fabs(c->sine - std::sin(angle)) < 1e-6);
    }
    const Ray ray{{1, 2, 3}, glm::normalize(Vec3(1, 2, -2))};
    CHECK_FALSE(crossing_of(ray, ray));
    CHECK_FALSE(crossing_of(ray, {{0, 0, 1}, ray.direction}));
    CHECK_FALSE(crossing_of(ray, {{0, 0, 1}, -ray.direction}));
}

TEST_CASE("a query beam crosses the light beams that all pairs say", "[upbp][beams]") {
    const media::HomogeneousMedium fog(Rgb(0.5f), Rgb(0.0f), Rgb(0.0f),
                                       std::make_shared<media::IsotropicPhase>());
    const std::vector<Subpath> paths(1);
    Rng rng(11);
    std::size_t found = 0;
    for (const BeamLength length : {BeamLength::short_beam, BeamLength::long_beam})
        for (const double radius : {0.01, 0.2, 50.0}) {
            const auto rows = random_beams(100, fog, rng);
            MergeSettings merging;
            merging.radius[std::size_t(Merge::beam_beam_1d)] = radius, merging.light_beams = length;
            const LightBeams beams(paths, rows, merging, 2.0, Rng(1));
            REQUIRE(beams.size() == 100);
            for (int i = 0; i < 50; ++i) {
                const Ray query{Vec3(in_cube(rng)), Vec3(unit_vector(rng)), 0.0f, 2.0f};
                std::vector<LightBeams::Hit> hits;
                beams.crossings(query, hits);
                CHECK(std::is_sorted(hits.begin(), hits.end(),
                                     [](const auto& a, const auto& b) { return a.t < b.t; }));
                std::vector<const LightBeam*> ours, all;
                for (const LightBeams::Hit& hit : hits) ours.push_back(&beams.beam(hit));
                for (const auto& row : rows)
                    for (const LightBeam& b : row) {
                        const auto c = crossing_of(query, b.beam.ray);
                        if (c && c->apart < radius && c->t > 0.0 && float(c->t) < query.t_max &&
                            c->s >= 0.0 && float(c->s) < b.beam.end(length))
                            all.push_back(&b);
                    }
                std::sort(ours.begin(), ours.end()), std::sort(all.begin(), all.end());
                CHECK(ours == all);
                found += all.size();
            }
        }
    CHECK(found > 1000);
}
