// Directional maps: directions survive the round trip, solid angles are those of the texels, and the slips of
// the printed equations.

#include "tools/directional_maps/directional_map.h"

#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/objects/error.h"
#include "lights/directional_maps/octahedral_map.h"
#include "tests/support/catch.h"
#include "tests/support/pearson.h"
#include "tools/directional_maps/texel_solid_angle.h"

using namespace mote::core;
using namespace mote::lights;
using namespace mote::tools;
using mote::tests::chi2_survival;

namespace {

constexpr double pi_d = 3.14159265358979323846;

/// Axes, edges and corners of octahedron and cube, what lies closely beside them, and both signs of zero.
std::vector<Vec3> special_directions() {
    std::vector<Vec3> result;
    const float values[] = {-1.0f, -1e-4f, -1e-8f, -0.0f, 0.0f, 1e-8f, 1e-4f, 1.0f};
    for (const float x : values)
        for (const float y : values)
            for (const float z : values)
                if (const Vec3 v(x, y, z); glm::dot(v, v) > 0.5f) result.push_back(glm::normalize(v));
    return result;
}

std::vector<Vec3> many_directions() {
    std::vector<Vec3> result = special_directions();
    Rng rng(1);
    for (int i = 0; i < 50000; ++i) result.push_back(square_to_sphere({rng.next_float(), rng.next_float()}));
    return result;
}

bool hemisphere(const DirectionalMap& map) { return map.domain() < 7.0; }

/// Rounding of 2^-24 in uv, and in a few operations before and after, times how far a direction moves with
/// uv: at most 2 pi for most maps. The radius of a sphere map has an infinite derivative at the rim, where 1
/// - r^2 loses half of the digits: sqrt(2^-24) times a few.
double round_trip_error(MapKind kind) { return kind == MapKind::sphere ? 2e-3 : 1e-6; }

/// Pearson's chi-square of even directions counted by texel, against the solid angles of texels of `angles`.
double even_directions_p_value(const DirectionalMap& map, const DirectionalMap& angles) {
    constexpr int samples = 200000;
    Rng rng(7);
    std::vector<double> counts(std::size_t(map.texels()), 0.0);
    for (int i = 0; i < samples; ++i) {
        Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
        if (hemisphere(map)) d.z = std::fabs(d.z);
        counts[std::size_t(map.texel(d))] += 1.0;
    }
    double statistic = 0.0, pooled_count = 0.0, pooled_expected = 0.0;
    int cells = 0;
    const auto add = [&](double count, double expected) {
        statistic += (count - expected) * (count - expected) / expected;
        ++cells;
    };
    for (int t = 0; t < map.texels(); ++t) {
        const double expected = samples * angles.solid_angle(t) / angles.domain();
        if (expected >= 5.0) {
            add(counts[std::size_t(t)], expected);
        } else {
            pooled_count += counts[std::size_t(t)];
            pooled_expected += expected;
        }
    }
    if (pooled_expected >= 5.0) add(pooled_count, pooled_expected);
    return chi2_survival(statistic, cells - 1);
}

}  // namespace

TEST_CASE("Directions survive the way to a map and back", "[directional_map]") {
    for (const MapKindName& k : map_kinds()) {
        const auto map = make_directional_map(k.kind, 7);
        double worst = 0.0;
        bool in_range = true;
        for (const Vec3& d : many_directions()) {
            if (hemisphere(*map) && d.z < 0.0f) continue;
            const MapPoint p = map->project(d);
            in_range = in_range && p.face >= 0 && p.face < map->faces() && p.uv.x >= 0.0f && p.uv.x <= 1.0f &&
                       p.uv.y >= 0.0f && p.uv.y <= 1.0f;
            worst = std::max(worst, double(glm::length(map->unproject(p) - d)));
            worst = std::max(worst, double(glm::length(map->unproject(map->project(3.0f * d)) - d)));
        }
        INFO(k.name << ": " << worst);
        CHECK(in_range);
        CHECK(worst < round_trip_error(k.kind));
    }
}

TEST_CASE("A texel's centre lies in the texel", "[directional_map]") {
    for (const MapKindName& k : map_kinds())
        for (const int size : {1, 2, 5, 16}) {
            const auto map = make_directional_map(k.kind, size);
            int elsewhere = 0;
            for (int t = 0; t < map->texels(); ++t)
                // Around a disc, centres belong to the continuation, which is stored elsewhere.
                if (map->used_fraction(t) == 1.0 && map->texel(map->direction(t)) != t) ++elsewhere;
            INFO(k.name << " " << size);
            CHECK(elsewhere == 0);
        }
}

TEST_CASE("The structs for hot loops and the interface agree", "[directional_map]") {
    const OctahedralMap square{9};
    const HemiOctahedralMap half{9};
    const auto square_map = make_directional_map(MapKind::octahedral, 9);
    const auto half_map = make_directional_map(MapKind::hemi_octahedral, 9);
    int different = 0;
    for (const Vec3& d : many_directions())
        different += int(square.texel(d) != square_map->texel(d)) + int(half.texel(d) != half_map->texel(d));
    for (int t = 0; t < square.texels(); ++t)
        different += int(square.direction(t) != square_map->direction(t)) +
                     int(half.direction(t) != half_map->direction(t));
    CHECK(different == 0);
}

TEST_CASE("Solid angles of all texels sum to that of the sphere", "[directional_map]") {
    for (const MapKindName& k : map_kinds())
        for (const int size : {1, 2, 3, 7, 16, 33, 128}) {
            const auto map = make_directional_map(k.kind, size);
            double sum = 0.0, mean_inverse = 0.0, used = 0.0;
            for (int t = 0; t < map->texels(); ++t) {
                sum += map->solid_angle(t);
                mean_inverse += map->solid_angle(t) / map->domain() * map->sampling_ratio(t);
                used += map->used_fraction(t);
            }
            INFO(k.name << " " << size << ": " << sum - map->domain());
            CHECK(std::fabs(sum - map->domain()) < 1e-11);
            // Sampling ratios are densities: their mean over the sphere is 1.
            CHECK(mean_inverse == Approx(1.0).epsilon(1e-11));
            CHECK(used == Approx(map->used_fraction() * map->texels()).epsilon(1e-11));
        }
}

TEST_CASE("Even directions fall into texels by their solid angles", "[directional_map]") {
    // Bonferroni over 16 tests at 1 % in all.
    for (const MapKindName& k : map_kinds())
        for (const int size : {6, 7}) {
            const auto map = make_directional_map(k.kind, size);
            INFO(k.name << " " << size);
            CHECK(even_directions_p_value(*map, *map) > 0.01 / 16);
        }
    // The solid angles of another projection onto the same square are found out.
    CHECK(even_directions_p_value(*make_directional_map(MapKind::octahedral, 7),
                                  *make_directional_map(MapKind::octahedral_perspective, 7)) < 1e-6);
}

TEST_CASE("Solid angles that are known", "[directional_map]") {
    CHECK(cube_rectangle({{-1, -1}, {1, 1}}) == Approx(4.0 * pi_d / 6.0).epsilon(1e-14));
    CHECK(cube_rectangle({{0, 0}, {1, 1}}) == Approx(pi_d / 6.0).epsilon(1e-14));
    CHECK(octahedral_polygon(std::array{glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1)}, 1.0) ==
          Approx(pi_d / 2.0).epsilon(1e-14));
    CHECK(disc_area({{-1, -1}, {1, 1}}) == Approx(pi_d).epsilon(1e-14));
    CHECK(disc_area({{0.8, 0.8}, {1, 1}}) == 0.0);
    CHECK(disc_area({{-0.1, -0.2}, {0.1, 0.2}}) == Approx(0.08).epsilon(1e-14));
    CHECK(paraboloid_rectangle({{-1, -1}, {1, 1}}) == Approx(2.0 * pi_d).epsilon(1e-14));
    // A square within the disc: int int 4 / (1 + x^2 + y^2)^2 over [0, h]^2 = 4 h / c atan(h / c), c^2 = 1 +
    // h^2.
    const double h = 0.5, c = std::sqrt(1.0 + h * h);
    CHECK(paraboloid_rectangle({{0, 0}, {h, h}}) == Approx(4.0 * h / c * std::atan(h / c)).epsilon(1e-13));
}

TEST_CASE("A perspective projection onto the faces of the octahedron is the planar one",
          "[directional_map]") {
    const auto planar = make_directional_map(MapKind::octahedral, 8);
    const auto straight = make_perspective_octahedral_map(8, 1.0f);
    const auto tilted = make_directional_map(MapKind::octahedral_perspective, 8);
    double straight_off = 0.0, tilted_off = 0.0;
    for (int t = 0; t < planar->texels(); ++t) {
        straight_off = std::max(straight_off, std::fabs(straight->solid_angle(t) - planar->solid_angle(t)));
        tilted_off = std::max(tilted_off, std::fabs(tilted->solid_angle(t) - planar->solid_angle(t)));
    }
    CHECK(straight_off == 0.0);
    CHECK(tilted_off > 0.01);
}

TEST_CASE("Slip: in Eq. 7.2, sign(0) is +1", "[directional_map][slips]") {
    for (const float zero : {0.0f, -0.0f}) {
        const Vec3 d(zero, 0.6f, -0.8f);
        const Vec2 p = octahedral_project(d);
        CHECK(glm::length(octahedral_unproject(p) - d) < 1e-6f);
        CHECK(std::fabs(p.x) == Approx(1.0f - 0.6f / 1.4f));
        // As printed, sigma(0) = 0, the first coordinate vanishes: another direction altogether.
        CHECK(glm::length(octahedral_unproject({0.0f, p.y}) - d) > 0.5f);
    }
    CHECK(std::fabs(octahedral_project({0.0f, 0.0f, -1.0f}).x) == 1.0f);
}

TEST_CASE("Slip: the inverse of Eq. 5.1 divides by 2 pi and pi", "[directional_map][slips]") {
    const auto map = make_directional_map(MapKind::latitude_longitude, 4);
    const MapPoint p = map->project({0, 1, 0});
    CHECK(p.uv.x == Approx(0.25f));
    CHECK(p.uv.y == Approx(0.5f));
    // Printed: atan2 and acos as they are, both pi/2, which Eq. 5.1 takes to other directions.
    CHECK(glm::length(map->unproject({0, {pi / 2, pi / 2}}) - Vec3(0, 1, 0)) > 0.5f);
}

TEST_CASE("Slip: the two halves of Eq. 7.3 meet in the middle", "[directional_map][slips]") {
    const auto map = make_directional_map(MapKind::octahedral_rectangle, 4);
    for (const float y : {0.1f, 0.4f, 0.9f}) {
        const auto gap = [&](float a, float b) {
            return glm::length(map->unproject({0, {a, y}}) - map->unproject({0, {b, y}}));
        };
        CHECK(gap(0.4999f, 0.5001f) < 2e-3f);
        CHECK(gap(0.0001f, 0.9999f) < 2e-3f);
    }
    // As printed, x'' = x' - y' + 1 below: at the left of the lower half lies what faces the right of the
    // upper.
    const Vec3 upper = hemi_octahedral_unproject({1.0f, 0.0f}),
               lower = hemi_octahedral_unproject({-1.0f, 0.0f});
    CHECK(glm::length(upper + lower) < 1e-6f);
}

TEST_CASE("Slip: the sphere map has the viewer's side in its middle", "[directional_map][slips]") {
    const auto map = make_directional_map(MapKind::sphere, 4);
    CHECK(glm::length(map->project({0, 0, 1}).uv - Vec2(0.5f)) < 1e-6f);
    CHECK(map->project({0.6f, 0, 0.8f}).uv.x > 0.5f);
    // The front hemisphere within sqrt(2) / 2, as the text says.
    CHECK(glm::length(map->project({1, 0, 0}).uv - Vec2(0.5f)) == Approx(0.5f * std::sqrt(0.5f)));
}

TEST_CASE("Unknown kinds and impossible sizes are refused", "[directional_map]") {
    CHECK(parse_map_kind("cube") == MapKind::cube);
    CHECK_THROWS_WITH(parse_map_kind("octahdral"), ContainsSubstring("did you mean 'octahedral'"));
    CHECK_THROWS_AS(make_directional_map(MapKind::cube, 0), InputError);
    CHECK_THROWS_AS(make_directional_map(MapKind::cube, 16385), InputError);
    CHECK_THROWS_AS(make_perspective_octahedral_map(4, 0.0f), InputError);
}
