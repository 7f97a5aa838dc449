// Volumetric shadow maps against closed forms and quadrature: every view, surfaces, limits.
#include "lights/shadow_maps/volumetric_shadow_map.h"

#include <fmt/format.h>

#include <cmath>

#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/objects/error.h"
#include "lights/shadow_maps/shadow_map_cells.h"
#include "media/heterogeneous_medium.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using lights::ShadowMapSettings, lights::ShadowMapView, lights::VolumetricShadowMap;

namespace {

std::vector<ShadowMapView> all_views(int size) {
    const Vec3 axis = glm::normalize(Vec3(0.2f, -0.3f, -1.0f));
    return {ShadowMapView::of_point(Vec3(0.1f, 0.2f, 3.0f), size),
            ShadowMapView::of_surface(Vec3(0.1f, 0.2f, 3.0f), axis, size),
            ShadowMapView::of_spot(Vec3(0.1f, 0.2f, 3.0f), axis, 0.9f, size),
            ShadowMapView::of_parallel(axis, Vec3(0.0f), 4.0f, size)};
}

/// A ball of fog around the origin, radius 2, over a floor at z = -3.
std::unique_ptr<Scene> ball(const std::string& sigma_t) {
    return tests::scene_from(R"(<scene version="3.0.0">
        <shape type="sphere"><float name="radius" value="2"/><bsdf type="null"/>
          <medium type="homogeneous" name="interior"><rgb name="sigma_t" value=")" +
                             sigma_t + R"("/></medium></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="20"/><translate z="-3"/></transform></shape>
        <emitter type="point"><point name="position" x="0" y="0" z="3"/></emitter><sensor type="perspective"/></scene>)");
}

/// A closed box filled with fog up to its walls, and a light in it.
std::unique_ptr<Scene> full_box() {
    return tests::scene_from(R"(<scene version="3.0.0"><medium type="homogeneous" id="fog">
          <rgb name="sigma_t" value="0.3, 0.8, 1.5"/></medium>
        <shape type="cube"><boolean name="flip_normals" value="true"/></shape>
        <emitter type="point"><point name="position" x="0.1" y="0.2" z="-0.3"/></emitter>
        <sensor type="perspective"><ref id="fog"/></sensor></scene>)");
}

/// Where a line enters and leaves the ball, as distances from `o` along the unit vector `d`; no length where
/// it misses.
std::pair<double, double> ball_part(const Vec3d& o, const Vec3d& d) {
    const double half = -glm::dot(o, d), discriminant = half * half - glm::dot(o, o) + 4.0;
    const double root = std::sqrt(std::max(discriminant, 0.0));
    return {std::max(half - root, 0.0), std::max(half + root, 0.0)};
}

/// Value of a map without rounding: bilinear mean of the lengths inside the ball along the rays of the four
/// texels around `p`, up to the distance of `p`.
double interpolated_length(const ShadowMapView& view, const Vec3& p) {
    lights::ShadowMapCells<1> cell;
    lights::find_cells<1>(view, &p.x, &p.y, &p.z, cell);
    double sum = 0.0;
    for (int c = 0; c < 4; ++c) {
        const int place = cell.corner[0] + c % 2 + c / 2 * (view.size + 2);
        const Ray ray = view.ray(view.neighbour(place % (view.size + 2) - 1, place / (view.size + 2) - 1));
        const auto [enter, leave] = ball_part(Vec3d(ray.origin), Vec3d(ray.direction));
        const double weight = (c % 2 ? double(cell.s[0]) : 1.0 - double(cell.s[0])) *
                              (c / 2 ? double(cell.t[0]) : 1.0 - double(cell.t[0]));
        sum += weight * (std::clamp(double(cell.distance[0]), enter, leave) - enter);
    }
    return sum;
}

/// RMS of the relative error of a map over random points of a box, against residual-free estimates by
/// `exact`.
template <typename Exact>
double rms_error(const VolumetricShadowMap& map, const Bounds3& box, const Exact& exact, int points = 4000) {
    Rng rng(3);
    double sum = 0.0;
    for (int i = 0; i < points; ++i) {
        const Vec3 p =
            box.lower + Vec3(rng.next_float(), rng.next_float(), rng.next_float()) * box.diagonal();
        const double e = exact(p);
        sum += std::pow(double(map.transmittance(p).y) / e - 1.0, 2.0);
    }
    return std::sqrt(sum / points);
}

}  // namespace

TEST_CASE("a point on a texel's ray is seen by that texel at its distance", "[shadow_map]") {
    for (const ShadowMapView& view : all_views(9))
        for (int texel = 0; texel < view.texels(); ++texel) {
            const Ray ray = view.ray(texel);
            REQUIRE(glm::length(ray.direction) == Approx(1.0f));
            const Vec3 p = ray.at(2.5f);
            lights::ShadowMapCells<1> cell;
            lights::find_cells<1>(view, &p.x, &p.y, &p.z, cell);
            REQUIRE(cell.inside[0] == 1.0f);
            CHECK(cell.distance[0] == Approx(2.5f));
            float weight = 0.0f;
            for (int c = 0; c < 4; ++c) {
                const int place = cell.corner[0] + c % 2 + c / 2 * (view.size + 2);
                const int seen = view.neighbour(place % (view.size + 2) - 1, place / (view.size + 2) - 1);
                const float across = c % 2 ? cell.s[0] : 1.0f - cell.s[0];
                if (seen == texel) weight += across * (c / 2 ? cell.t[0] : 1.0f - cell.t[0]);
            }
            CHECK(weight > 0.999f);
        }
}

// Along a ray the optical depth is linear between entry and exit, so that intervals lose nothing;
// between rays it is interpolated. What is left is the rounding of stored depths to half of depth_unit, that
// of entry and step in single precision (a millionth of some metres), and that of the exponential.
TEST_CASE("shadow maps of homogeneous fog are the closed form, per channel", "[shadow_map]") {
    const auto scene = ball("0.1, 0.5, 2");
    {
        for (const ShadowMapView& view : all_views(64)) {
            VolumetricShadowMap map;
            map.build(*scene, view, MediumState(), ShadowMapSettings());
            Rng rng(1);
            for (int i = 0; i < 500; ++i) {
                const Vec3 p = 2.0f * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 1.0f;
                const double length = interpolated_length(view, p);
                const Rgb t = map.transmittance(p);
                INFO("kind " << int(view.kind));
                for (const auto& [channel, sigma_t] : {std::pair{0, 0.1}, {1, 0.5}, {2, 2.0}}) {
                    const double rounding =
                        0.5 * double(VolumetricShadowMap::depth_unit) + 1e-5 * sigma_t + 1e-5;
                    CHECK(std::fabs(-std::log(double(t[channel])) - sigma_t * length) < rounding);
                }
            }
            // Before the fog nothing is lost, behind the floor nothing arrives.
            CHECK(map.transmittance(Vec3(0.1f, 0.15f, 2.6f) + 0.0f) == Rgb(1.0f));
            CHECK(map.transmittance(Vec3(0.3f, 0.1f, -4.5f)) == Rgb(0.0f));
            CHECK(map.transmittance(Vec3(0.3f, 0.1f, -2.99f)).x > 0.0f);
        }
    }
}

// The optical depth is linear along every ray, so intervals lose nothing however few: what
// is left is the rounding of stored depths, half of depth_unit, and that of the exponential, 4e-6.
TEST_CASE("fog up to the walls: few intervals are the closed form, also on the walls", "[shadow_map]") {
    const auto scene = full_box();
    const Rgb sigma_t(0.3f, 0.8f, 1.5f);
    const Vec3 light(0.1f, 0.2f, -0.3f);
    for (const int intervals : {1, 3, 11}) {
        ShadowMapSettings settings;
        settings.intervals = intervals;
        VolumetricShadowMap map;
        map.build(*scene, ShadowMapView::of_point(light, 64), scene->medium_state_at(light, nullptr),
                  settings);
        Rng rng(6);
        for (int i = 0; i < 500; ++i) {
            const Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
            const auto wall = scene->rays().closest(Ray{light, d});
            REQUIRE(wall);
            const float distance = i % 2 == 0 ? wall->t : wall->t * rng.next_float();
            const Rgb t = map.transmittance(light + distance * d);
            INFO(intervals << " intervals, " << distance << " of " << wall->t << " m");
            for (int c = 0; c < 3; ++c) {
                const double depth = double(sigma_t[c]) * double(distance);
                CHECK(double(t[c]) ==
                      Approx(std::exp(-depth)).epsilon(0.5 * double(VolumetricShadowMap::depth_unit) + 2e-5));
            }
        }
    }
}

// Two balls of fog apart from each other: entry and exit fall into the middle of intervals, whose ends are
// exact.
TEST_CASE("several media along a ray count from where they begin", "[shadow_map]") {
    const auto fog_ball = [](double z, double radius, double sigma_t) {
        return fmt::format(R"(<shape type="sphere"><point name="center" x="0" y="0" z="{}"/>
            <float name="radius" value="{}"/><bsdf type="null"/><medium type="homogeneous" name="interior">
            <float name="sigma_t" value="{}"/></medium></shape>)",
                           z, radius, sigma_t);
    };
    const auto scene = tests::scene_from(R"(<scene version="3.0.0">)" + fog_ball(1.0, 0.55, 0.4) +
                                         fog_ball(-1.2, 0.7, 1.1) + R"(<emitter type="point">
            <point name="position" x="0" y="0" z="3"/></emitter><sensor type="perspective"/></scene>)");
    VolumetricShadowMap map;
    ShadowMapSettings settings;
    settings.intervals = 13;
    const ShadowMapView view = ShadowMapView::of_spot(Vec3(0, 0, 3), Vec3(0, 0, -1), 0.3f, 9);
    map.build(*scene, view, MediumState(), settings);
    const Ray ray = view.ray(40);  // the middle one, along the axis
    REQUIRE(glm::length(ray.direction - Vec3(0, 0, -1)) < 1e-6f);
    const float enter = 1.45f, step = (4.9f - enter) / 13.0f;
    const auto length = [](float t, float begin, float end) { return std::clamp(t, begin, end) - begin; };
    for (int k = 0; k <= 13; ++k) {
        const float t = enter + float(k) * step;
        const float depth = 0.4f * length(t, 1.45f, 2.55f) + 1.1f * length(t, 3.5f, 4.9f);
        INFO("interval " << k);
        CHECK(-std::log(map.transmittance(ray.at(t)).x) == Approx(depth).margin(1e-3));
    }
}

TEST_CASE("shadow maps of smoke approach quadrature with size and intervals", "[shadow_map]") {
    const tests::TemporaryFolder folder;
    const auto scene =
        tests::scene_from(tests::box(tests::grey, tests::smoke_medium(folder.file("smoke.vol"))), 8);
    const ShadowMapView small = ShadowMapView::of_point(Vec3(0.05f, 0.9f, 0.1f), 32);
    ShadowMapView large = small;
    large.size = 128;
    const Bounds3 smoke{Vec3(-0.9f, -0.85f, -0.9f), Vec3(0.9f, 0.85f, 0.9f)};
    const auto exact = [&](const Vec3& p) {
        const Medium& m = *scene->media().front();
        Vec3d depth(0.0);
        const int steps = 1000;
        for (int i = 0; i < steps; ++i) {
            const Vec3 q = small.origin + (float(i) + 0.5f) / float(steps) * (p - small.origin);
            if (smoke.contains(q)) depth += Vec3d(m.coefficients(q).sigma_t);
        }
        return std::exp(-depth.y * double(glm::distance(p, small.origin)) / steps);
    };
    const Bounds3 inside{Vec3(-0.8f, -0.3f, -0.8f), Vec3(0.8f, 0.8f, 0.8f)};  // above the block
    const auto error = [&](const ShadowMapView& view, int intervals) {
        ShadowMapSettings settings;
        settings.intervals = intervals;
        VolumetricShadowMap map;
        map.build(*scene, view, scene->medium_state_at(view.origin, nullptr), settings);
        return rms_error(map, inside, exact, 300);
    };
    const double coarse = error(small, 8), fine = error(large, 128);
    INFO("32^2 x 8: " << coarse << ", 128^2 x 128: " << fine);
    CHECK(coarse > 0.01);
    CHECK(fine < 0.006);
    CHECK(fine < 0.25 * coarse);
}

TEST_CASE("transmittance never rises along a ray, and is exactly one at the light", "[shadow_map]") {
    const tests::TemporaryFolder folder;
    const auto scene =
        tests::scene_from(tests::box(tests::grey, tests::smoke_medium(folder.file("smoke.vol"))), 8);
    {
        ShadowMapSettings settings;
        VolumetricShadowMap map;
        const ShadowMapView view = ShadowMapView::of_point(Vec3(0.0f, 0.1f, 0.2f), 48);  // inside the smoke
        map.build(*scene, view, scene->medium_state_at(view.origin, nullptr), settings);
        Rng rng(2);
        for (int i = 0; i < 300; ++i) {
            const Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
            CHECK(map.transmittance(view.origin + 1e-6f * d).y == Approx(1.0f).epsilon(1e-4));
            float before = 1.0f;
            for (float t = 0.01f; t < 3.0f; t *= 1.1f) {
                const float now = map.transmittance(view.origin + t * d).y;
                REQUIRE(now <= before * 1.0001f);
                REQUIRE(now >= 0.0f);
                before = now;
            }
        }
    }
}

TEST_CASE("a map larger than its limit is refused with the size that would fit", "[shadow_map]") {
    const auto scene = ball("1");
    ShadowMapSettings settings;
    settings.max_bytes = 1 << 20;
    VolumetricShadowMap map;
    CHECK_THROWS_WITH(map.build(*scene, ShadowMapView::of_point(Vec3(0, 0, 3), 256), MediumState(), settings),
                      ContainsSubstring("256 x 256") && ContainsSubstring("102 x 102 would fit"));
    map.build(*scene, ShadowMapView::of_point(Vec3(0, 0, 3), 102), MediumState(), settings);
    CHECK(map.memory_bytes() <= settings.max_bytes);
    // Memory is taken once: a smaller map fits into that of a larger one.
    const std::size_t before = map.memory_bytes();
    map.build(*scene, ShadowMapView::of_surface(Vec3(0, 0, 3), Vec3(0, 0, -1), 32), MediumState(), settings);
    CHECK(map.memory_bytes() == before);
    settings.intervals = 0;
    CHECK_THROWS_AS(map.build(*scene, ShadowMapView::of_point(Vec3(0), 8), MediumState(), settings),
                    InputError);
}

TEST_CASE("a scene without media gives a plain shadow map", "[shadow_map]") {
    const auto scene = tests::scene_from(tests::box(tests::grey, ""), 8);
    VolumetricShadowMap map;
    map.build(*scene, ShadowMapView::of_point(Vec3(0.0f, 0.8f, 0.0f), 128), MediumState(), {});
    CHECK(map.transmittance(Vec3(-0.7f, -0.9f, 0.0f)) == Rgb(1.0f));
    CHECK(map.transmittance(Vec3(0.33f, -0.95f, -0.2f)) == Rgb(0.0f));  // below the block
}

TEST_CASE("walls seen at grazing angles do not shadow themselves, and do not leak", "[shadow_map]") {
    const auto scene = tests::scene_from(tests::box(tests::grey, ""), 8);
    const Vec3 light(-0.3f, -0.97f, 0.1f);  // close above the floor: its walls and the floor are all grazed
    VolumetricShadowMap map;
    map.build(*scene, ShadowMapView::of_surface(light, Vec3(0, 1, 0), 64), MediumState(), {});
    Rng rng(7);
    double lit = 0.0, missing = 0.0, leaked = 0.0, through = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 eye(1.6f * rng.next_float() - 0.8f, 1.8f * rng.next_float() - 0.9f, 0.8f);
        const auto hit =
            scene->rays().closest(Ray{eye, square_to_sphere({rng.next_float(), rng.next_float()})});
        if (!hit) continue;  // the box is open to the front
        const Vec3 p = offset_origin(*hit, eye - hit->position), d = p - light;
        const float cosine = -glm::dot(hit->geometric_normal, d) / glm::length(d);
        const float weight = std::fabs(cosine) * std::max(d.y, 0.0f) / glm::length(d);
        const bool seen = !scene->rays().occluded(Ray{p, -d, 0.0f, 0.9999f});
        const double transmittance = double(map.transmittance(p).x);
        (seen ? lit : leaked) += double(weight) * (seen ? 1.0 : transmittance);
        if (!seen) continue;
        missing += double(weight) * (1.0 - transmittance);
        // A hand's breadth behind the same wall there is no light.
        through += double(weight) * double(map.transmittance(p + 0.3f * glm::normalize(d)).x);
    }
    INFO("missing " << missing / lit << ", leaked " << leaked / lit << ", through " << through / lit);
    CHECK(missing < 0.01 * lit);
    CHECK(leaked < 0.02 * lit);
    CHECK(through < 0.1 * lit);
}

TEST_CASE("one march for all intervals is the sum of marches", "[shadow_map]") {
    const tests::TemporaryFolder folder;
    const auto scene =
        tests::scene_from(tests::box(tests::grey, tests::smoke_medium(folder.file("smoke.vol"))), 8);
    const auto& smoke = dynamic_cast<const media::HeterogeneousMedium&>(*scene->media().front());
    Rng rng(8);
    TrackingCounters one, many;
    std::vector<Vec3d> depths(13);
    double largest = 0.0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
        const Ray ray{Vec3(0.1f, -0.2f, 0.3f) - 0.7f * d, d, 0.05f, 1.35f};
        smoke.optical_depths_by_marching(ray, 0.02f, depths, one);
        Vec3d sum(0.0);
        for (int k = 0; k < 13; ++k) {
            const float from = 0.05f + 0.1f * float(k);
            sum += smoke.optical_depth_by_marching(Ray{ray.origin, d, from, from + 0.1f}, 0.02f, many);
            REQUIRE(depths[std::size_t(k)].x == Approx(sum.x).epsilon(0.01).margin(0.005));
            if (k > 0) REQUIRE(depths[std::size_t(k)].x >= depths[std::size_t(k) - 1].x);
        }
        largest = std::max(largest, sum.x);
    }
    CHECK(largest > 1.0);
    CHECK(one.lookups > 0);
}
