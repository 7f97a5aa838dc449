// Every emitter samples what it claims, by the chi-square test of directions: connections against
// pdf_direct(), the directions of particles and the points where they start against pdf_solid_angle and
// pdf_area.
//
// The densities that particles carry are compared with pdf_emission() and with a density written down here,
// and pdf_emission() with the samples. Points on a surface are counted as directions in which they are
// seen from a point that sees every one of them; points on the disk of lights at infinity as directions of
// the hemisphere, onto which the disk is mapped with equal areas.
#include <set>

#include "core/geometry/ray_tracer.h"
#include "tests/lights/emitter_examples.h"
#include "tests/lights/emitter_statistics.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"
#include "tests/support/registered_cases.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

/// The registered type that an example of light_examples() represents.
std::string type_of(const LightExample& example) {
    if (example.shape) return "area";
    for (const std::string type : {"spot", "projector"})
        if (example.name == "textured " + type) return type;
    return example.name;
}

Chi2Options options(const LightExample& example, const std::string& what) {
    Chi2Options o;
    o.name = "emitter_" + example.name + "_" + what;
    o.seed = hash_keys(0x656d6974ull, example.name.size(), what.size());
    o.samples = 60000, o.cos_cells = 8, o.phi_cells = 16;
    o.tests = 62;  // a bound of what this file runs
    o.subdivisions = 2;
    return o;
}

/// The light's shape alone, for rays.
struct Target {
    explicit Target(const LightExample& example) : shapes{example.shape}, rays(shapes) {}
    std::vector<std::shared_ptr<Shape>> shapes;
    RayTracer rays;
};

void check(const Chi2Result& result) {
    INFO(result.message);
    CHECK(result.passed);
}

// Connections -----------------------------------------------------------------------------------------------

const Vec3 receivers[] = {Vec3(0.0f), Vec3(0.4f, -0.3f, 0.1f)};

/// Cells over a cap that holds the shape as seen from p, a little askew, or over the sphere.
void aim(Chi2Options& o, const LightExample& example, const Vec3& p) {
    if (!example.shape) return;
    const Bounds3 box = example.shape->bounds();
    const Vec3 center = 0.5f * (box.lower + box.upper);
    o.frame = Frame(glm::normalize(center - p + 0.03f * Vec3(0.5f, -1.0f, 0.2f)));
    o.cap = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 c(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                     corner & 4 ? box.upper.z : box.lower.z);
        o.cap = std::max(o.cap, 1.0 - double(glm::dot(glm::normalize(c - p), o.frame.n)));
    }
    if (glm::all(glm::lessThan(box.lower, p)) && glm::all(glm::lessThan(p, box.upper))) o.cap = 2.0;
    o.cap = std::min(2.0, 1.05 * o.cap);
}

DirectionSampler connections(const Emitter& light, const Vec3& p) {
    return [&light, p](Rng& rng) -> std::optional<Vec3> {
        const auto s = light.sample_direct(p, rng.next_vec2());
        return s ? std::optional<Vec3>(s->wi) : std::nullopt;
    };
}

/// pdf_direct() of the surface seen in a direction; what is behind the first hit is not seen by paths either.
DirectionDensity connection_density(const LightExample& example, const Target* target, const Vec3& p) {
    const Emitter* light = example.light.get();
    return [light, target, p](const Vec3& wi) -> double {
        if (!target) return double(light->pdf_direct(p, wi, nullptr));
        const auto hit = target->rays.closest(Ray{p, wi, 0.0f, infinity});
        return hit ? double(light->pdf_direct(p, wi, &*hit)) : 0.0;
    };
}

// Particles -------------------------------------------------------------------------------------------------

std::optional<EmissionSample> particle(const Emitter& light, Rng& rng) {
    const Vec2 u_position = rng.next_vec2();
    return light.sample_emission(u_position, rng.next_vec2());
}

/// The direction of a particle, as its density is written down: about the normal on surfaces, in the world
/// elsewhere.
Vec3 direction_of(const LightExample& example, const EmissionSample& s) {
    return example.shape ? Frame(s.normal).to_local(s.direction) : s.direction;
}

/// Density of the particles' directions [1/sr]; empty for parallel light.
std::optional<DirectionDensity> particle_density(const LightExample& example) {
    const Emitter* light = example.light.get();
    if (light->traits().delta_direction) return std::nullopt;
    if (example.shape) return [](const Vec3& w) { return std::fmax(0.0, double(w.z)) / double(pi); };
    if (light->traits().infinite) return [=](const Vec3& w) { return light->pdf_direct({}, -w, nullptr); };
    if (type_of(example) == "spot") {  // even over the cone: cutoff 20 degrees, see light_examples()
        const Vec3d axis = glm::normalize(facing_down({0.3, -0.2, 2.0}, 0.1).vector(Vec3d(0, 0, 1)));
        const double cosine = std::cos(20.0 * double(pi) / 180.0);
        return [=](const Vec3& w) {
            return glm::dot(Vec3d(w), axis) > cosine ? 1.0 / (2.0 * double(pi) * (1.0 - cosine)) : 0.0;
        };
    }
    if (example.name == "projector") {  // even over a square of 0.6 at distance 1, see light_examples()
        const glm::dmat3 local = glm::transpose(glm::dmat3(facing_down({0.3, -0.2, 2.0}, 0.1).matrix));
        return [=](const Vec3& w) {
            const Vec3d d = local * Vec3d(w);
            const bool inside = d.z > 0.0 && std::fabs(d.x) < 0.3 * d.z && std::fabs(d.y) < 0.3 * d.z;
            return inside ? 1.0 / (0.36 * d.z * d.z * d.z) : 0.0;
        };
    }
    if (type_of(example) == "projector")
        return [=](const Vec3& w) { return light->pdf_emission({}, {}, w).pdf_solid_angle; };
    return [](const Vec3&) { return double(inv_four_pi); };
}

/// A point that sees every point of the shape exactly once.
Vec3 witness_of(const LightExample& example) {
    const Bounds3 box = example.shape->bounds();
    const Vec3 center = 0.5f * (box.lower + box.upper);
    const std::string& name = example.name;
    const bool flat = name.find("rectangle") != std::string::npos || name == "disk";
    return flat ? Vec3(0.05f, 0.1f, 0.2f) : center + 0.05f * Vec3(1.0f, 0.4f, -0.7f);
}

/// Where particles start on a shape, as directions from the witness.
DirectionSampler starts_on_shape(const Emitter& light, const Vec3& witness) {
    return [&light, witness](Rng& rng) -> std::optional<Vec3> {
        const auto s = particle(light, rng);
        return s ? std::optional<Vec3>(glm::normalize(s->origin - witness)) : std::nullopt;
    };
}
DirectionDensity start_density(const Target& target, const Vec3& witness, const Emitter& light) {
    return [&target, witness, &light](const Vec3& w) -> double {
        const auto hit = target.rays.closest(Ray{witness, w, 0.0f, infinity});
        if (!hit) return 0.0;
        const Vec3& n = hit->geometric_normal;
        const double pdf_area = double(light.pdf_emission(hit->position, n, n).pdf_area);
        const double cosine = std::fabs(double(glm::dot(hit->geometric_normal, w)));
        return pdf_area * double(hit->t) * double(hit->t) / cosine;
    };
}

/// Where particles start on the disk of a light at infinity (centre (0, 0, 1), see light_examples()): the
/// disk's squared radius becomes 1 - cos.
DirectionSampler starts_on_disk(const Emitter& light) {
    return [&light](Rng& rng) -> std::optional<Vec3> {
        const auto s = particle(light, rng);
        if (!s) return std::nullopt;
        const Vec3 at = Frame(s->direction).to_local(s->origin - Vec3(0, 0, 1));
        const double h = (double(at.x) * at.x + double(at.y) * at.y) * double(pi) * double(s->pdf_area);
        const double phi = std::atan2(double(at.y), double(at.x)), r = std::sqrt(h * (2.0 - h));
        return Vec3(Vec3d(r * std::cos(phi), r * std::sin(phi), 1.0 - h));
    };
}
/// The density of that, from pdf_emission() at points of rays through the disk.
DirectionDensity disk_density(const Emitter& light, const EmissionSample& some) {
    return [&light, some](const Vec3& w) {
        const Frame frame(some.direction);
        const float r = std::sqrt(std::fmax(0.0f, 1.0f - w.z) / (pi * some.pdf_area));
        const float phi = std::atan2(w.y, w.x);
        const Vec3 across = r * (std::cos(phi) * frame.s + std::sin(phi) * frame.t);
        const Vec3 p = Vec3(0, 0, 1) + across + 1.7f * some.direction;  // anywhere along the ray
        return double(light.pdf_emission(p, Vec3(0.0f), some.direction).pdf_area / some.pdf_area) *
               double(inv_two_pi);
    };
}
double on_hemisphere(const Vec3& w) { return w.z > -1e-6f ? double(inv_two_pi) : 0.0; }

/// pdf_emission() of directions as direction_of() counts them, at the origin of some particle.
DirectionDensity direction_density(const LightExample& example, const EmissionSample& some) {
    const Emitter* light = example.light.get();
    return [light, some, on_shape = example.shape != nullptr](const Vec3& w) {
        const Vec3 direction = on_shape ? Frame(some.normal).to_world(w) : w;
        return double(light->pdf_emission(some.origin, some.normal, direction).pdf_solid_angle);
    };
}

}  // namespace

TEST_CASE("connections to every light follow pdf_direct", "[lights][emitters][chi2]") {
    for (const auto& example : light_examples()) {
        if (!example.light->traits().can_be_hit()) continue;
        std::optional<Target> target;
        if (example.shape) target.emplace(example);
        for (const Vec3& p : receivers) {
            Chi2Options o = options(example, "direct");
            aim(o, example, p);
            check(chi2_test(connections(*example.light, p),
                            connection_density(example, target ? &*target : nullptr, p), o));
        }
    }
}

TEST_CASE("directions of particles follow pdf_solid_angle", "[lights][emitters][chi2]") {
    for (const auto& example : light_examples()) {
        INFO(example.name);
        const auto density = particle_density(example);
        Rng rng(5);
        std::optional<Vec3> only;
        std::optional<EmissionSample> some;
        for (int i = 0; i < 1000; ++i) {
            const auto s = particle(*example.light, rng);
            if (!s) continue;
            some = s;
            const EmissionDensity pdf = example.light->pdf_emission(s->origin, s->normal, s->direction);
            REQUIRE(pdf.pdf_area == Approx(s->pdf_area).epsilon(1e-5));
            // A direction is rounded to some 1e-7, which narrow cells of a picture show near the poles.
            REQUIRE(pdf.pdf_solid_angle == Approx(s->pdf_solid_angle).epsilon(2e-3).margin(1e-5));
            if (density) {
                const double expected = (*density)(direction_of(example, *s));
                REQUIRE(s->pdf_solid_angle == Approx(expected).epsilon(2e-3).margin(1e-5));
            } else {
                if (!only) only = s->direction;
                REQUIRE(s->direction == *only);
            }
        }
        if (!density) continue;
        Chi2Options o = options(example, "directions");
        if (type_of(example) == "projector") o.subdivisions = 4;  // its rim is sharp
        if (type_of(example) == "spot" || type_of(example) == "projector")
            o.frame = Frame(glm::normalize(Vec3(0.02f, 0.03f, -1.0f))), o.cap = 0.12;
        const auto sampled = [&](Rng& r) -> std::optional<Vec3> {
            const auto s = particle(*example.light, r);
            return s ? std::optional<Vec3>(direction_of(example, *s)) : std::nullopt;
        };
        check(chi2_test(sampled, direction_density(example, *some), o));
    }
}

TEST_CASE("nothing is emitted where no particle goes", "[lights][emitters]") {
    for (const auto& example : light_examples()) {
        INFO(example.name);
        const auto pdf = [&](const Vec3& p, const Vec3& n, const Vec3& w) {
            return example.light->pdf_emission(p, n, w);
        };
        Rng rng(6);
        std::optional<EmissionSample> s;
        while (!s) s = particle(*example.light, rng);
        if (example.shape) CHECK(pdf(s->origin, s->normal, -s->direction).pdf_solid_angle == 0.0f);
        if (type_of(example) == "spot" || type_of(example) == "projector")
            CHECK(pdf(s->origin, {}, Vec3(0, 0, 1)).pdf_solid_angle == 0.0f);
        if (!example.light->traits().infinite) continue;
        // The disk has the radius of the scene, three metres and a thousandth.
        const Vec3 side = Frame(s->direction).s, center(0, 0, 1);
        CHECK(pdf(center + 2.99f * side, {}, s->direction).pdf_area == s->pdf_area);
        CHECK(pdf(center + 3.01f * side, {}, s->direction).pdf_area == 0.0f);
    }
}

TEST_CASE("particles start where pdf_area says", "[lights][emitters][chi2]") {
    for (const auto& example : light_examples()) {
        INFO(example.name);
        const Chi2Options o = options(example, "positions");
        Rng rng(5);
        std::optional<EmissionSample> first;
        for (int i = 0; i < 1000 && !first; ++i) first = particle(*example.light, rng);
        REQUIRE(first);
        for (int i = 0; i < 1000; ++i)
            if (const auto s = particle(*example.light, rng))
                REQUIRE(s->pdf_area == Approx(first->pdf_area).epsilon(1e-5));
        if (example.light->traits().delta_position) {
            CHECK(first->pdf_area == 1.0f);
            CHECK(particle(*example.light, rng)->origin == first->origin);
        } else if (example.shape) {
            const Target target(example);
            const Vec3 witness = witness_of(example);
            Chi2Options seen = o;
            aim(seen, example, witness);
            check(chi2_test(starts_on_shape(*example.light, witness),
                            start_density(target, witness, *example.light), seen));
        } else {
            check(chi2_test(starts_on_disk(*example.light), disk_density(*example.light, *first), o));
        }
    }
}

TEST_CASE("every registered emitter has a chi-square case", "[lights][emitters][chi2][coverage]") {
    std::set<std::string> tested;
    for (const auto& example : light_examples()) tested.insert(type_of(example));
    for (const std::string& complaint : untested_types(registry(), Category::emitter, tested))
        FAIL_CHECK(complaint);
    Registry larger = registry();
    larger.add({Category::emitter, "lantern", "", {}, ""}, [](const Properties&) { return nullptr; });
    CHECK(untested_types(larger, Category::emitter, tested) ==
          std::vector<std::string>{"no chi² case for emitter 'lantern'"});
}

TEST_CASE("planted errors of emitters are caught", "[lights][emitters][chi2][planted]") {
    const auto planted = [](const LightExample& example) {
        Chi2Options o = options(example, "planted");
        o.write_table = false;
        return o;
    };
    for (const auto& example : light_examples()) {
        const std::string& name = example.name;
        if (name != "envmap" && name != "disk" && name != "sphere") continue;
        INFO(name);
        std::optional<Target> target;
        if (example.shape) target.emplace(example);
        Chi2Options o = planted(example);
        aim(o, example, receivers[0]);
        const auto sampled = connections(*example.light, receivers[0]);
        const auto density = connection_density(example, target ? &*target : nullptr, receivers[0]);
        REQUIRE(chi2_test(sampled, density, o).passed);
        // A density off by three per cent.
        for (const double factor : {0.97, 1.03})
            CHECK_FALSE(chi2_test(
                            sampled, [&](const Vec3& w) { return factor * density(w); }, o)
                            .passed);
        // Samples for another receiver, a tenth of a metre away; environments have none.
        if (example.shape)
            CHECK_FALSE(chi2_test(connections(*example.light, Vec3(0.1f, 0, 0)), density, o).passed);
    }
    for (const auto& example : light_examples()) {
        if (example.name != "constant" && example.name != "directional") continue;
        // A disk three per cent larger or smaller than that of the particles.
        Rng rng(5);
        const auto some = particle(*example.light, rng);
        const auto starts = starts_on_disk(*example.light);
        const auto right = disk_density(*example.light, *some);
        for (const double factor : {0.97, 1.03})
            CHECK_FALSE(chi2_test(
                            starts, [&](const Vec3& w) { return factor * right(w); }, planted(example))
                            .passed);
    }
    for (const auto& example : light_examples()) {
        if (example.name != "disk") continue;
        // The cosine of emission dropped: even over the hemisphere.
        const auto sampled = [&](Rng& r) -> std::optional<Vec3> {
            return direction_of(example, *particle(*example.light, r));
        };
        CHECK_FALSE(chi2_test(sampled, on_hemisphere, planted(example)).passed);
        // The cosine forgotten between area and solid angle.
        const Target target(example);
        const Vec3 witness = witness_of(example);
        Chi2Options o = planted(example);
        aim(o, example, witness);
        const double pdf = 1.0 / double(example.shape->area());
        const auto starts = starts_on_shape(*example.light, witness);
        const auto right = start_density(target, witness, *example.light);
        REQUIRE(chi2_test(starts, right, o).passed);
        for (const double factor : {0.97, 1.03})
            CHECK_FALSE(chi2_test(
                            starts, [&](const Vec3& w) { return factor * right(w); }, o)
                            .passed);
        const auto without_cosine = [&](const Vec3& w) -> double {
            const auto hit = target.rays.closest(Ray{witness, w, 0.0f, infinity});
            return hit ? pdf * double(hit->t) * double(hit->t) : 0.0;
        };
        CHECK_FALSE(chi2_test(starts, without_cosine, o).passed);
    }
}
