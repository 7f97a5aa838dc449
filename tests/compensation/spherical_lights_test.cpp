// Spherical lights against a quadrature of their defining integral, written without SphereCone, and against
// the point lights that they become where r -> 0. Planted errors show that the tests can fail.
#include <algorithm>
#include <cmath>
#include <functional>

#include "compensation/spherical_lights.h"
#include "core/materials/bsdfs.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using compensation::SphericalLight;

namespace {

const double pi_d = std::acos(-1.0);
const auto diffuse = make_twosided(make_diffuse());  // reflectance 0.5

BsdfPtr metal(float alpha) {
    return make_twosided(make_rough_conductor({{Rgb(0.2f, 0.9f, 1.2f), Rgb(3.9f, 2.4f, 2.2f)}},
                                              Microfacet(MicrofacetKind::ggx, alpha)));
}
BsdfPtr coated() { return make_twosided(make_rough_plastic({}, Microfacet(MicrofacetKind::ggx, 0.2f))); }

ScatteringVertex vertex(const BsdfPtr& bsdf, const Vec3& position, const Vec3& normal, const Vec3& wo) {
    ScatteringVertex v;
    v.position = v.hit.position = position, v.wo = glm::normalize(wo), v.bsdf = bsdf.get();
    v.hit.geometric_normal = glm::normalize(normal), v.hit.shading = Frame(glm::normalize(normal));
    return v;
}

/// A receiver, and a light that power alpha arrived at.
struct Pair {
    BsdfPtr receiver_bsdf, light_bsdf;
    ScatteringVertex x, y;
    float radius;
    lights::VplSet set;
    static Rgb alpha() { return {2.0f, 1.0f, 0.5f}; }

    Pair(BsdfPtr at_x, BsdfPtr at_y, const Vec3& position, const Vec3& normal, float r,
         const Vec3& viewer = {-1, 0, 1}, const Vec3& source = {-1, 1, 0})
        : receiver_bsdf(std::move(at_x)),
          light_bsdf(std::move(at_y)),
          x(vertex(receiver_bsdf, {0, 0, 0}, {0, 0, 1}, viewer)),
          y(vertex(light_bsdf, position, normal, source)),
          radius(r) {
        append_vpl(set, y, alpha(), 1, 0);
        REQUIRE(set.lights.size() == 1);
    }
    SphericalLight light() const { return {set, 0, radius}; }
    double distance() const { return double(glm::length(y.position - x.position)); }

    /// f(x, wo, w) |cos_x| f(y, w_j, -w) |cos_y| alpha.
    Vec3d integrand(const Vec3& w) const {
        return Vec3d(x.eval_cos(w, TransportMode::radiance)) *
               Vec3d(y.eval(-w, TransportMode::power) * alpha()) *
               std::fabs(double(glm::dot(y.hit.geometric_normal, w)));
    }
    /// The light as a point: f G f alpha.
    Vec3d point() const {
        return integrand(glm::normalize(y.position - x.position)) / (distance() * distance());
    }
    /// 1 / (pi r^2) times the integral over the cone, by the midpoint rule in its angles.
    Vec3d quadrature(const std::function<double(const Vec3&)>& factor = nullptr) const {
        const double d = distance(), r = double(radius);
        const double widest = d <= r ? pi_d : std::asin(r / d);
        const Frame frame(d > 0.0 ? glm::normalize(y.position - x.position) : Vec3(0, 0, 1));
        const int n_theta = 350, n_phi = 700;
        Vec3d sum(0.0);
        for (int i = 0; i < n_theta; ++i) {
            const double theta = (i + 0.5) / n_theta * widest;
            for (int j = 0; j < n_phi; ++j) {
                const double phi = (j + 0.5) / n_phi * 2.0 * pi_d;
                const Vec3 w = frame.to_world(Vec3(Vec3d(std::sin(theta) * std::cos(phi),
                                                         std::sin(theta) * std::sin(phi), std::cos(theta))));
                sum += integrand(w) * (std::sin(theta) * (factor ? factor(w) : 1.0));
            }
        }
        return sum * (widest / n_theta * 2.0 * pi_d / n_phi) / (pi_d * r * r);
    }
};

/// Is the mean of `sample(rng)` the expected value, in all channels? Two-sided at 4.5 sigma (7e-6 a channel),
/// with 1e-3 of the value for the quadrature.
bool has_mean(const Vec3d& expected, int n, const std::function<Vec3d(Rng&)>& sample) {
    Rng rng(hash_keys(11, 7));
    Vec3d sum(0.0), squares(0.0);
    for (int i = 0; i < n; ++i) {
        const Vec3d v = sample(rng);
        sum += v, squares += v * v;
    }
    bool good = true;
    for (int c = 0; c < 3; ++c) {
        const double mean = sum[c] / n, variance = std::max(0.0, squares[c] / n - mean * mean) / (n - 1);
        good = good && std::fabs(mean - expected[c]) <= 4.5 * std::sqrt(variance) + 1e-3 * expected[c];
        UNSCOPED_INFO("channel " << c << ": " << mean << " +- " << std::sqrt(variance) << ", expected "
                                 << expected[c]);
    }
    return good;
}

std::function<Vec3d(Rng&)> estimator(const Pair& p, int samples) {
    return [&p, samples](Rng& rng) {
        return Vec3d(compensation::unoccluded_light(p.x, p.light(), samples, rng));
    };
}

/// Diffuse and glossy at both ends; the sphere narrow, wide, and around the receiver.
std::vector<Pair> pairs() {
    std::vector<Pair> all;
    for (const auto& [at_x, at_y] :
         {std::pair(BsdfPtr(diffuse), BsdfPtr(diffuse)), std::pair(metal(0.15f), BsdfPtr(diffuse)),
          std::pair(BsdfPtr(diffuse), metal(0.15f)), std::pair(metal(0.15f), metal(0.3f)),
          std::pair(coated(), coated())})
        for (const float r : {0.2f, 1.2f, 2.5f})
            all.emplace_back(at_x, at_y, Vec3(1, 0, 1), Vec3(-1, 0, 0.3f), r);
    return all;
}

std::string closed_box(const std::string& bsdf) {
    return R"(<scene version="3.0.0"><shape type="cube"><boolean name="flip_normals" value="true"/>)" + bsdf +
           R"(</shape><shape type="cube"><transform name="to_world"><scale value="0.3"/>
        <translate x="0.4" y="-0.7" z="0.1"/></transform>)" +
           bsdf + R"(</shape><emitter type="point"><point name="position" x="0.1" y="0.3" z="-0.2"/>
        <rgb name="intensity" value="2, 1, 0.5"/></emitter><sensor type="perspective"/></scene>)";
}
const std::string grey = R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf>)";
const std::string shiny = R"(<bsdf type="roughconductor"><float name="alpha" value="0.4"/></bsdf>)";

ScatteringVertex seen(const Scene& scene, const Vec3& origin, const Vec3& direction) {
    const Ray ray{origin, glm::normalize(direction)};
    WalkContext context;
    PathWeights weights;
    Rgb emitted;
    MediumState state;
    return make_vertex(walk<false>(scene, ray, state, weights, emitted, context), ray);
}

lights::VplSet box_lights(const Scene& scene) {
    lights::LightPathSettings settings;
    settings.paths = 100;
    return lights::trace_light_paths(scene, settings, 7, 0, SamplerKind::independent);
}

}  // namespace

TEST_CASE("the estimate has the mean of the integral over the cone", "[vsl]") {
    for (const Pair& p : pairs()) {
        const Vec3d expected = p.quadrature();
        REQUIRE(expected.x > 0.0);
        for (const int samples : {1, 4, 6}) {
            INFO("radius " << p.radius << ", " << samples << " samples, directional light "
                           << (p.light().detail != nullptr));
            CHECK(has_mean(expected, 60000 / samples, estimator(p, samples)));
        }
    }
}

TEST_CASE("an integral without one of the cosines is distinguished", "[vsl][planted]") {
    for (const Pair& p : pairs()) {
        const auto forgotten = [](const Vec3& normal) {
            return [normal](const Vec3& w) {
                return 1.0 / std::max(1e-3, std::fabs(double(glm::dot(normal, w))));
            };
        };
        CHECK_FALSE(has_mean(p.quadrature(forgotten(p.x.hit.geometric_normal)), 10000, estimator(p, 6)));
        CHECK_FALSE(has_mean(p.quadrature(forgotten(p.y.hit.geometric_normal)), 10000, estimator(p, 6)));
        CHECK_FALSE(has_mean(1.1 * p.quadrature(), 10000, estimator(p, 6)));
    }
}

// Estimators with the mistakes that other code makes, each beside its right form.
TEST_CASE("wrong densities are distinguished", "[vsl][planted]") {
    const Pair wide(diffuse, diffuse, {1, 0, 1}, {-1, 0, 0.3f}, 1.2f);
    const double d = wide.distance(), sin2 = double(wide.radius) * double(wide.radius) / (d * d);
    const double height = 1.0 - std::sqrt(1.0 - sin2), per_disc = 2.0 * height / (sin2 * d * d);
    // A point at r u instead of r sqrt(u) crowds the directions around the centre.
    const auto cone = [&](bool square_root) {
        return [&, square_root](Rng& rng) {
            const Vec2 u = rng.next_vec2();
            const Vec2 on_disc(square_root ? u.x : u.x * u.x, u.y);
            const Frame frame(glm::normalize(wide.y.position));
            return wide.integrand(frame.to_world(square_to_cone(on_disc, float(height)))) * per_disc;
        };
    };
    CHECK(has_mean(wide.quadrature(), 60000, cone(true)));
    CHECK_FALSE(has_mean(wide.quadrature(), 60000, cone(false)));

    // Two techniques, a direction each; without the other one's density in the weight light counts twice.
    const Pair p(metal(0.15f), diffuse, {1, 0, 1}, {-1, 0, 0.3f}, 1.2f);
    const compensation::SphereCone c(p.x.position, p.y.position, p.radius);
    const auto combined = [&](bool both) {
        return [&, both](Rng& rng) {
            const double uniform = 1.0 / double(c.solid_angle()), disc = pi_d * double(p.radius * p.radius);
            Vec3d sum(0.0);
            const auto density = [&](const Vec3& w) {
                return double(p.x.pdf_solid_angle(w, TransportMode::radiance));
            };
            const Vec3 w = c.sample(rng.next_vec2());
            sum += p.integrand(w) / (disc * (uniform + (both ? density(w) : 0.0)));
            const float u_lobe = rng.next_float();
            const auto s = p.x.sample(u_lobe, rng.next_vec2(), TransportMode::radiance);
            if (s && c.contains(s->wi))
                sum += p.integrand(s->wi) / (disc * ((both ? uniform : 0.0) + density(s->wi)));
            return sum;
        };
    };
    CHECK(has_mean(p.quadrature(), 60000, combined(true)));
    CHECK_FALSE(has_mean(p.quadrature(), 60000, combined(false)));
}

// Receiver and light at the same place face each other: the integral of cos^2 over a hemisphere is 2 pi / 3.
TEST_CASE("inside the sphere the integral is over all directions", "[vsl]") {
    const Pair p(diffuse, diffuse, {0, 0, 0.001f}, {0, 0, -1}, 0.5f, {0, 0, 1}, {0, 0, -1});
    const double f = 0.5 / pi_d;
    const Vec3d exact = Vec3d(Pair::alpha()) * (f * f * 2.0 * pi_d / 3.0 / (pi_d * 0.25));
    CHECK(has_mean(exact, 60000, estimator(p, 4)));
    CHECK_FALSE(
        has_mean(0.5 * exact, 60000, estimator(p, 4)));  // a hemisphere's density instead of a sphere's
}

TEST_CASE("a sphere of radius zero is a point light, and small ones approach it", "[vsl][limit]") {
    Rng rng(5);
    int lit = 0;
    for (int i = 0; i < 300; ++i) {
        const auto direction = [&] { return square_to_sphere(rng.next_vec2()); };
        const BsdfPtr kinds[] = {diffuse, metal(0.3f), coated()};
        Pair p(kinds[i % 3], kinds[i / 3 % 3], direction() * (0.1f + 3.0f * rng.next_float()), direction(),
               0.0f, direction(), direction());
        const Vec3d point = p.point();
        lit += point.x > 0.0;
        const auto estimate = [&] { return compensation::unoccluded_light(p.x, p.light(), 4, rng); };
        INFO("pair " << i);
        for (const float r : {0.0f, 1e-12f, 1e-6f}) {
            p.radius = r;
            const Rgb value = estimate();
            for (int c = 0; c < 3; ++c) CHECK(value[c] == Approx(point[c]).epsilon(1e-3).margin(1e-4));
        }
    }
    CHECK(lit > 50);
}

TEST_CASE("extremes of radius and distance stay finite", "[vsl][extremes]") {
    Rng rng(6);
    for (const float d : {0.0f, 1e-30f, 1e-12f, 1e-3f, 1.0f, 1e4f, 1e15f})
        for (const float r : {0.0f, 1e-30f, 1e-20f, 1e-8f, 1.0f, 1e6f, 1e18f})
            for (const float relative : {1.0f, 0.999999f, 1.000001f}) {
                const float exact = r == 1.0f ? d * relative : r;  // also r next to d
                const Pair p(metal(0.05f), metal(0.05f), Vec3(1, 0, 1) * d, {-1, 0, 0.1f}, exact);
                for (int i = 0; i < 20; ++i) {
                    const Rgb value = compensation::unoccluded_light(p.x, p.light(), 6, rng);
                    INFO("distance " << d << " radius " << exact);
                    REQUIRE(is_finite(value));
                    REQUIRE(min_component(value) >= 0.0f);
                }
            }
}

TEST_CASE("radii reach to the k-th nearest light", "[vsl][radius]") {
    const auto scene = scene_from(closed_box(grey));
    lights::VplSet set = box_lights(*scene);
    REQUIRE(set.lights.size() > 60);
    for (const std::uint32_t k : {1u, 10u}) {
        const auto radii = compensation::sphere_radii(set, k, 0.5f);
        for (std::size_t i = 0; i < set.lights.size(); ++i) {
            std::vector<float> distances;
            for (const auto& other : set.lights)
                distances.push_back(glm::length(other.position - set.lights[i].position));
            std::nth_element(distances.begin(), distances.begin() + k, distances.end());
            CHECK(radii[i] == Approx(0.5 * double(distances[k])).epsilon(1e-5));
        }
    }
    set.lights.resize(2);
    const float between = glm::length(set.lights[0].position - set.lights[1].position);
    for (const float r : compensation::sphere_radii(set, 10, 1.0f)) CHECK(r == Approx(between));
    set.lights.resize(1);
    CHECK(compensation::sphere_radii(set, 10, 1.0f) == std::vector<float>{0.0f});
    set.lights.clear();
    CHECK(compensation::sphere_radii(set, 10, 1.0f).empty());
}

// With small spheres both kinds of visibility are the point light's. If the surface before the sphere could
// hide its own light, (1 + cos_y) / 2 of it would be left, however small the sphere.
TEST_CASE("gathering small spheres equals gathering points", "[vsl][limit][visibility]") {
    for (const std::string& bsdf : {grey, shiny}) {
        const auto scene = scene_from(closed_box(bsdf));
        const auto set = box_lights(*scene);
        Rng rng(3);
        Vec3d points(0.0), spheres[2] = {Vec3d(0.0), Vec3d(0.0)};
        for (int i = 0; i < 200; ++i) {
            const ScatteringVertex x = seen(*scene, {0, 0, 0}, square_to_sphere(rng.next_vec2()));
            lights::ReceiverTile tile;
            tile.set(0, x, Rgb(1.0f), MediumState{}, rng, 1000);
            lights::GatherScratch scratch;
            RayCounters rays;
            TrackingCounters tracking;
            points += Vec3d(lights::gather({*scene, scratch, rays, tracking}, set, lights::VplRange{},
                                           lights::BoundedGeometry{infinity}, tile)[0]);
            for (int kind = 0; kind < 2; ++kind) {
                compensation::SphericalGather settings;
                settings.visibility = compensation::SphereVisibility(kind);
                const std::vector<float> radii(set.lights.size(), 1e-4f);
                spheres[kind] +=
                    Vec3d(compensation::gather_spheres(*scene, set, radii, settings, x, 1000, rng, rays));
            }
        }
        REQUIRE(points.x > 0.0);
        for (const Vec3d& sum : spheres)
            for (int c = 0; c < 3; ++c) CHECK(sum[c] == Approx(points[c]).epsilon(0.01));
    }
}

// The light on top of the block does not shine around the edge to the block's side, although the receiver is
// inside its sphere: the way to the centre leads through the block.
TEST_CASE("light stays on its side of an edge and of a thin wall", "[vsl][visibility]") {
    const auto scene = scene_from(closed_box(R"(<bsdf type="twosided">)" + grey + "</bsdf>"));
    const ScatteringVertex top = seen(*scene, {0.4f, 0.5f, -0.15f}, {0, -1, 0});
    REQUIRE(top.position.y == Approx(-0.4f));
    lights::VplSet set;
    append_vpl(set, top, Rgb(1.0f), 1, 0);
    const ScatteringVertex side = seen(*scene, {0.4f, -0.45f, -0.8f}, {0, 0, 1});
    REQUIRE(side.position.z == Approx(-0.2f));
    const ScatteringVertex outside = seen(*scene, {-1.5f, 0.5f, 0.0f}, {1, 0, 0});  // behind the box's wall
    append_vpl(set, seen(*scene, {0, 0.5f, 0}, {-1, 0, 0}), Rgb(1.0f), 1, 0);
    const ScatteringVertex wall = seen(*scene, {0.4f, -0.2f, 0.1f}, {0, 0.3f, -1});

    Rng rng(8);
    RayCounters rays;
    for (const auto visibility :
         {compensation::SphereVisibility::per_sample, compensation::SphereVisibility::per_light})
        for (const float r : {0.05f, 0.2f, 0.6f}) {
            compensation::SphericalGather settings;
            settings.visibility = visibility, settings.samples = 64;
            const auto light = [&](const ScatteringVertex& x) {
                return compensation::gather_spheres(*scene, set, {r, r}, settings, x, 1000, rng, rays);
            };
            CHECK(light(outside).x == 0.0f);
            CHECK(light(wall).x > 0.0f);
            set.lights[1].depth = 2000;  // deeper than requested: left out
            CHECK(light(side).x == 0.0f);
            set.lights[1].depth = 1;
        }
}
