// Importance of every camera: its densities against its rays and its connections by chi-square tests, and the
// way to the camera against the way from it.
#include <set>

#include "core/math/pdf_conversion.h"
#include "core/math/warp.h"
#include "tests/core/cameras/camera_cases.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"
#include "tests/support/registered_cases.h"

using namespace mote::tests;

namespace {

constexpr double pixel_count = double(film_width) * film_height;
const Vec2 some_lens(0.3f, 0.8f);

Chi2Options options(const CameraCase& c, const std::string& what) {
    Chi2Options o;
    o.name = c.name + "_" + what;
    o.seed = hash_keys(0x63616d65ull, c.name.size(), what.size());
    o.samples = 60000, o.cos_cells = 8, o.phi_cells = 16;
    o.tests = 12;  // a bound of what this file runs
    o.subdivisions = 3;
    return o;
}

Vec2 anywhere_on_film(Rng& rng) { return film_size * rng.next_vec2(); }

/// Cells over a cap around `axis` that holds what `directions` samples, a little askew.
void aim(Chi2Options& o, const Vec3& axis, const DirectionSampler& directions) {
    o.frame = Frame(glm::normalize(axis + 0.03f * Vec3(0.5f, -1.0f, 0.2f)));
    Rng rng(9);
    double cap = 0.0;
    for (int i = 0; i < 20000; ++i) cap = std::max(cap, 1.0 - double(glm::dot(*directions(rng), o.frame.n)));
    o.cap = std::min(2.0, 1.05 * cap);
}

void check(const Chi2Result& result) {
    INFO(result.message);
    CHECK(result.passed);
}

// Rays: directions from one point on the lens, or origins of parallel rays as they are seen from a witness.

Vec3 witness_of(const CameraCase& c) { return c.camera().position() + 1.5f * c.forward(); }

DirectionSampler rays(const CameraCase& c) {
    return [&c](Rng& rng) -> std::optional<Vec3> {
        const Ray ray = c.camera().sample_ray(anywhere_on_film(rng), some_lens);
        if (!c.camera().traits().delta_direction) return ray.direction;
        return glm::normalize(ray.origin - witness_of(c));
    };
}

DirectionDensity ray_density(const CameraCase& c) {
    const Ray middle = c.camera().sample_ray(0.5f * film_size, some_lens);
    if (!c.camera().traits().delta_direction)
        return [&c, middle](const Vec3& w) {
            const auto i = c.camera().importance(middle.origin, w, 0.0f);
            return i ? double(i->pdf_solid_angle) / pixel_count : 0.0;
        };
    const Vec3 normal = glm::normalize(glm::cross(c.axis({1, 0, 0}), c.axis({0, 1, 0})));
    return [&c, middle, normal](const Vec3& w) -> double {
        const Vec3 from = witness_of(c);
        const float t = glm::dot(middle.origin - from, normal) / glm::dot(w, normal);
        if (!(t > 0.0f)) return 0.0;
        const auto i = c.camera().importance(from + t * w, middle.direction, 0.0f);
        if (!i) return 0.0;
        // Per area of the picture, which may be tilted against the rays.
        const float pdf_area = i->pdf_area * std::fabs(glm::dot(normal, middle.direction));
        return double(area_to_solid_angle(pdf_area, t * t, glm::dot(normal, w))) / pixel_count;
    };
}

// Connections to the lens.

const Vec3d in_view(0.4, -0.3, 1.7);  // in camera space

DirectionSampler connections(const CameraCase& c, const Vec3& p) {
    return [&c, p](Rng& rng) -> std::optional<Vec3> {
        const auto s = c.camera().sample_importance(p, rng.next_vec2(), 100.0f);
        return s ? std::optional<Vec3>(s->wi) : std::nullopt;
    };
}

/// From the density of points on the lens.
double lens_density(const CameraCase& c, const Vec3& p, const Vec3& wi) {
    const float cosine = -glm::dot(wi, c.forward());
    const float distance = glm::dot(p - c.camera().position(), c.forward()) / cosine;
    const Vec3 origin = p + distance * wi;
    if (!(cosine > 0.0f) || glm::length(origin - c.camera().position()) > c.lens_radius) return 0.0;
    const auto i = c.camera().importance(origin, -wi, 100.0f);
    return i ? double(area_to_solid_angle(i->pdf_area, distance * distance, cosine)) : 0.0;
}

}  // namespace

TEST_CASE("camera rays follow the densities of their importance", "[cameras][chi2]") {
    for (const CameraCase& c : camera_cases()) {
        Chi2Options o = options(c, "rays");
        aim(o, c.camera().traits().delta_direction ? -c.forward() : c.forward(), rays(c));
        check(chi2_test(rays(c), ray_density(c), o));
        // Planted: three per cent, and the cosine of Jacobians one power off.
        o.write_table = false;
        const auto density = ray_density(c);
        const auto off = [&](const Vec3& w) { return 0.97 * density(w); };
        CHECK_FALSE(chi2_test(rays(c), off, o).passed);
        if (c.camera().traits().delta_direction) continue;
        o.samples = 600000;
        const auto flatter = [&](const Vec3& w) { return density(w) * double(glm::dot(w, c.forward())); };
        CHECK_FALSE(chi2_test(rays(c), flatter, o).passed);
    }
}

TEST_CASE("connections to the camera follow their density", "[cameras][chi2]") {
    for (const CameraCase& c : camera_cases()) {
        INFO(c.name);
        const Vec3 p(c.camera().to_world().point(in_view));
        const CameraTraits traits = c.camera().traits();
        Rng rng(3);
        const auto first = c.camera().sample_importance(p, rng.next_vec2(), 100.0f);
        REQUIRE(first);
        CHECK(first->delta == (traits.delta_position || traits.delta_direction));
        for (int i = 0; i < 1000; ++i) {
            const auto s = c.camera().sample_importance(p, rng.next_vec2(), 100.0f);
            REQUIRE(s);
            if (first->delta)
                REQUIRE((s->wi == first->wi && s->pdf_solid_angle == 0.0f && s->weight == first->weight));
            else
                REQUIRE(s->pdf_solid_angle == Approx(lens_density(c, p, s->wi)).epsilon(1e-4).margin(0.0));
        }
        if (first->delta) continue;
        Chi2Options o = options(c, "connections");
        aim(o, first->wi, connections(c, p));
        const auto density = [&](const Vec3& wi) { return lens_density(c, p, wi); };
        check(chi2_test(connections(c, p), density, o));
        o.write_table = false;
        const auto off = [&](const Vec3& w) { return 1.03 * density(w); };
        CHECK_FALSE(chi2_test(connections(c, p), off, o).passed);
        const Vec3 moved = p + 0.02f * c.axis({1, 0, 0});
        CHECK_FALSE(chi2_test(connections(c, moved), density, o).passed);
    }
}

TEST_CASE("the way to the camera is the way from it", "[cameras]") {
    for (const CameraCase& c : camera_cases()) {
        INFO(c.name);
        const Camera& camera = c.camera();
        const CameraTraits traits = camera.traits();
        Rng rng(4);
        for (int i = 0; i < 1000; ++i) {
            const Vec2 film = anywhere_on_film(rng), lens = rng.next_vec2();
            const Ray ray = camera.sample_ray(film, lens);
            const float t = lerp(ray.t_min, ray.t_max, 0.01f + 0.98f * rng.next_float());
            const auto s = camera.sample_importance(ray.at(t), lens, 0.01f);
            const auto i_ray = camera.importance(ray.origin, ray.direction, 0.01f);
            REQUIRE(s);
            REQUIRE(i_ray);
            // Rounding of a point at a distance of some metres, seen in pixels of some centimetres.
            REQUIRE(glm::length(s->film_position - film) < 1e-3f);
            REQUIRE(glm::length(i_ray->film_position - film) < 1e-3f);
            REQUIRE(glm::length(s->wi + ray.direction) < 1e-5f);
            REQUIRE(glm::length(s->origin - ray.origin) < 1e-5f);
            REQUIRE(s->distance == Approx(t).epsilon(1e-5));
            REQUIRE(s->t_min == Approx(ray.t_min).epsilon(1e-4));
            // One ray a pixel has the density W_e cos: its weight is 1.
            const float cosine = traits.delta_direction ? 1.0f : glm::dot(ray.direction, c.forward());
            REQUIRE(i_ray->pdf_area * i_ray->pdf_solid_angle ==
                    Approx(i_ray->importance * cosine).epsilon(1e-5));
            const float pdf = traits.delta_position    ? s->distance * s->distance / cosine
                              : traits.delta_direction ? 1.0f
                                                       : s->pdf_solid_angle;
            REQUIRE(s->weight == Approx(i_ray->importance / pdf).epsilon(1e-3));
        }
    }
}

TEST_CASE("points that the camera does not see have no importance", "[cameras]") {
    for (const CameraCase& c : camera_cases()) {
        INFO(c.name);
        const Camera& camera = c.camera();
        const auto seen = [&](const Vec2& film, float t_factor, float margin) {
            const Ray ray = camera.sample_ray(film, Vec2(0.5f));
            return camera
                .project(ray.at(t_factor < 1.0f ? ray.t_max * t_factor : ray.t_min * t_factor), margin)
                .has_value();
        };
        const Vec2 middle = 0.5f * film_size;
        CHECK(seen(middle, 1.01f, 0.0f));  // just behind the near plane
        CHECK(seen(middle, 0.99f, 0.0f));  // just before the far plane
        const Ray ray = camera.sample_ray(middle, Vec2(0.5f));
        CHECK_FALSE(camera.project(ray.at(0.99f * ray.t_min)));
        CHECK_FALSE(camera.project(ray.at(1.01f * ray.t_max)));
        CHECK_FALSE(camera.project(ray.at(-2.0f)));  // behind the camera
        CHECK_FALSE(camera.project(camera.position()));
        for (const Vec2& off : {Vec2(-1.5f, 2.0f), Vec2(3.0f, -1.5f), film_size + Vec2(1.5f, -3.0f),
                                film_size + Vec2(-3.0f, 1.5f)}) {
            CHECK_FALSE(seen(off, 2.0f, 0.0f));
            CHECK_FALSE(seen(off, 2.0f, 1.4f));
            CHECK(seen(off, 2.0f, 1.6f));
            const Ray outside = camera.sample_ray(off, Vec2(0.5f));
            CHECK_FALSE(camera.importance(outside.origin, outside.direction, 1.4f));
            CHECK(camera.importance(outside.origin, outside.direction, 1.6f));
        }
        if (!camera.traits().delta_direction)
            CHECK_FALSE(camera.importance(ray.origin, -ray.direction, 100.0f));
    }
}

TEST_CASE("importance has no unit of length", "[cameras]") {
    for (const float scale : {1e-3f, 1e5f}) {
        const std::vector<CameraCase> metres = camera_cases(), scaled = camera_cases(double(scale));
        for (std::size_t k = 0; k < metres.size(); ++k) {
            INFO(metres[k].name << " times " << scale);
            const Vec3 p(metres[k].camera().to_world().point(in_view));
            const auto a = metres[k].camera().sample_importance(p, some_lens, 100.0f),
                       b = scaled[k].camera().sample_importance(scale * p, some_lens, 100.0f);
            REQUIRE(a);
            REQUIRE(b);
            CHECK(glm::length(a->film_position - b->film_position) < 1e-3f);
            CHECK(b->weight * scale * scale == Approx(a->weight).epsilon(1e-4));
            CHECK(b->distance == Approx(a->distance * scale).epsilon(1e-5));
            // A direction's density has none.
            CHECK(b->pdf_solid_angle == Approx(a->pdf_solid_angle).epsilon(1e-4));
            const auto i = metres[k].camera().importance(a->origin, -a->wi, 100.0f),
                       j = scaled[k].camera().importance(b->origin, -b->wi, 100.0f);
            REQUIRE(i);
            REQUIRE(j);
            CHECK(j->pdf_area * j->pdf_solid_angle / j->importance ==
                  Approx(i->pdf_area * i->pdf_solid_angle / i->importance).epsilon(1e-4));
            CHECK(is_finite(j->importance));
        }
    }
}

TEST_CASE("every registered sensor has a chi-square case", "[cameras][chi2][coverage]") {
    std::set<std::string> tested;
    for (const CameraCase& c : camera_cases()) tested.insert(c.type);
    for (const std::string& complaint : untested_types(registry(), Category::sensor, tested))
        FAIL_CHECK(complaint);
    Registry larger = registry();
    larger.add({Category::sensor, "fisheye", "", {}, ""}, [](const Properties&) { return nullptr; });
    CHECK(untested_types(larger, Category::sensor, tested) ==
          std::vector<std::string>{"no chi² case for sensor 'fisheye'"});
}
