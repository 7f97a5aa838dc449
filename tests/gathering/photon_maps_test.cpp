// Density estimates against densities that are known, and photons that are made thinner.
#include <cmath>

#include "core/math/warp.h"
#include "gathering/photon_maps/photon_tracer.h"
#include "gathering/photon_maps/progressive_radius.h"
#include "gathering/photon_maps/volume_photon_map.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;

namespace {

/// Mean of independent trials, and how far it is from `expected` in its own standard errors.
struct Trials {
    double sum = 0.0, squares = 0.0;
    int count = 0;
    void add(double x) { sum += x, squares += x * x, ++count; }
    double mean() const { return sum / count; }
    double z(double expected) const {
        const double variance = (squares / count - mean() * mean()) / (count - 1);
        return (mean() - expected) / std::sqrt(variance);
    }
};
constexpr double critical_z = 4.0;  // two-sided level 6e-5: a handful of tests fraction it

std::unique_ptr<Scene> foggy_scene() {
    return tests::scene_from(R"(<scene version="3.0.0">
        <shape type="cube"><transform name="to_world"><scale value="10"/></transform><bsdf type="null"/>
          <medium type="homogeneous" name="interior"><float name="sigma_t" value="0.5"/>
            <phase type="hg"><float name="g" value="0.3"/></phase></medium></shape>
        <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="0.4, 0.6, 0.8"/></bsdf></shape>
        <emitter type="point"><point name="position" x="0" y="0" z="3"/></emitter><sensor type="perspective"/></scene>)");
}

ScatteringVertex receiver_on(const Scene& scene) {
    const Ray ray{Vec3(0.1f, -0.05f, 2.0f), Vec3(0, 0, -1)};
    const auto hit = scene.rays().closest(ray);
    REQUIRE(hit);
    WalkEvent event;
    event.kind = WalkEvent::Kind::surface, event.hit = *hit, event.distance = hit->t;
    return make_vertex(event, ray);
}

/// `count` photons of power 1 / count, evenly over the unit rectangle's [-1,1]^2, all from above.
std::vector<Photon> photons_on_plane(int count, Rng& rng) {
    std::vector<Photon> photons(static_cast<std::size_t>(count));
    for (Photon& p : photons) {
        p.position = Vec3(2.0f * rng.next_float() - 1.0f, 2.0f * rng.next_float() - 1.0f, 0.0f);
        p.towards_light = encode_direction(Vec3(0.2f, 0.1f, 1.0f));
        p.power = Rgb(1.0f / float(count)), p.depth = 2, p.normal_or_medium = encode_normal(Vec3(0, 0, 1));
    }
    return photons;
}

}  // namespace

TEST_CASE("The radiance estimate of an even density is unbiased for every k and radius", "[photons]") {
    const auto scene = foggy_scene();
    const ScatteringVertex receiver = receiver_on(*scene);
    const double expected =
        0.25 * 0.6 * double(inv_pi);  // irradiance 1 W / 4 m^2, times the green albedo / pi
    Rng rng(3);
    std::vector<KdTree::Neighbour> scratch;
    for (const std::size_t k : {std::size_t(4), std::size_t(20)})
        for (const float fraction : {1.0f, 0.6f}) {
            Trials trials;
            for (int i = 0; i < 2500; ++i) {
                const SurfacePhotonMap map(photons_on_plane(400, rng));
                trials.add(map.radiance(receiver, {k, fraction}, 100, scratch).y);
            }
            INFO("k " << k << " fraction " << fraction << ": " << trials.mean() << " against " << expected);
            CHECK(std::fabs(trials.z(expected)) < critical_z);
            // Counting the k-th photon too is a factor k / (k - 1): the test sees it.
            CHECK(std::fabs(trials.z(expected * double(k) / double(k - 1))) > critical_z);
        }
}

TEST_CASE("Photons from below, on other walls or too deep do not count", "[photons]") {
    const auto scene = foggy_scene();
    const ScatteringVertex receiver = receiver_on(*scene);
    Rng rng(4);
    std::vector<KdTree::Neighbour> scratch;
    const auto light = [&](auto change) {
        auto photons = photons_on_plane(500, rng);
        for (Photon& p : photons) change(p);
        return SurfacePhotonMap(photons).radiance(receiver, {20, 1.0f}, 3, scratch).y;
    };
    CHECK(light([](Photon&) {}) > 0.0f);
    CHECK(light([](Photon& p) { p.depth = 3; }) > 0.0f);
    CHECK(light([](Photon& p) { p.depth = 4; }) == 0.0f);
    CHECK(light([](Photon& p) { p.towards_light = encode_direction(Vec3(0, 0.1f, -1)); }) == 0.0f);
    CHECK(light([](Photon& p) { p.normal_or_medium = encode_normal(Vec3(0, 1, 0)); }) == 0.0f);
    CHECK(SurfacePhotonMap().radiance(receiver, {}, 3, scratch) == Rgb(0.0f));
    CHECK(SurfacePhotonMap(photons_on_plane(1, rng)).radiance(receiver, {}, 3, scratch) == Rgb(0.0f));
}

TEST_CASE("The beam radiance estimate of an even density is the integral along the beam", "[photons]") {
    const auto scene = foggy_scene();
    const MediumState state = scene->medium_state_at(Vec3(0, 0, 1), nullptr);
    REQUIRE(state.current() != nullptr);
    // Density 1 / 216 per m^3 in [-3,3]^3; the beam stays far from the edges, so that kernels see no border.
    const Ray ray{Vec3(-1.2f, 0.3f, 1.5f), glm::normalize(Vec3(1, 0.1f, -0.2f))};
    const float t_max = 2.0f;
    const Vec3 towards_light = glm::normalize(Vec3(0.3f, 0.2f, 1));
    const double cosine = glm::dot(-ray.direction, towards_light), g = 0.3;
    const double phase = double(inv_four_pi) * (1 - g * g) / std::pow(1 + g * g + 2 * g * cosine, 1.5);
    const double expected = phase / 216.0 * (1.0 - std::exp(-0.5 * t_max)) / 0.5;
    Rng rng(8);
    for (const float fraction : {1.0f, 0.5f}) {
        Trials trials;
        for (int i = 0; i < 800; ++i) {
            std::vector<Photon> photons(2000);
            for (Photon& p : photons) {
                p.position = 6.0f * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 3.0f;
                p.towards_light = encode_direction(towards_light), p.power = Rgb(1.0f / 2000.0f);
                p.depth = 2, p.normal_or_medium = 0;
            }
            const VolumePhotonMap map(*scene, std::move(photons), {30, fraction}, 10.0f);
            WalkContext context;
            context.rng = Rng(std::uint64_t(i));
            std::vector<RayFacingDiscs::Hit> scratch;
            const BeamRadiance light = map.radiance(ray, t_max, state, 100, context, scratch);
            CHECK(light.single == Rgb(0.0f));
            trials.add(light.multiple.x);
        }
        INFO("fraction " << fraction << ": " << trials.mean() << " against " << expected << ", z "
                         << trials.z(expected));
        CHECK(std::fabs(trials.z(expected)) < critical_z);
        CHECK(std::fabs(trials.z(1.07 * expected)) > critical_z);
    }
}

TEST_CASE("Photons behind the first surface do not light a beam", "[photons]") {
    const auto scene = foggy_scene();
    std::vector<Photon> photons(3);
    for (int i = 0; i < 3; ++i)
        photons[std::size_t(i)] = {Vec3(0, 0, 1.0f + float(i)), encode_direction(Vec3(1, 0, 0)), Rgb(1.0f), 0,
                                   1};
    const VolumePhotonMap map(*scene, photons, {2, 1.0f}, 10.0f);
    WalkContext context;
    std::vector<RayFacingDiscs::Hit> scratch;
    const Ray ray{Vec3(0), Vec3(0, 0, 1)};
    const auto light = [&](float t_max) {
        return map.radiance(ray, t_max, {}, 5, context, scratch).single.x;
    };
    CHECK(light(0.9f) == 0.0f);
    CHECK(light(1.5f) > 0.0f);
    CHECK(light(2.5f) > light(1.5f));
    CHECK(light(infinity) > light(2.5f));
}

TEST_CASE("Thinning keeps the power of a photon set in the mean, and its size in bounds", "[photons]") {
    const auto scene = foggy_scene();
    PhotonSettings full;
    full.paths.paths = 1000;
    PhotonSettings thin = full;
    thin.max_photons = 100;
    const auto power = [](const PhotonSet& set) {
        double sum = 0.0;
        for (const auto* photons : {&set.surface, &set.volume})
            for (const Photon& p : *photons) sum += double(p.power.y);
        return sum;
    };
    Trials difference, relative;
    for (std::uint32_t pass = 0; pass < 300; ++pass) {
        const PhotonSet a = trace_photons(*scene, full, 1, pass, SamplerKind::sobol);
        const PhotonSet b = trace_photons(*scene, thin, 1, pass, SamplerKind::sobol);
        REQUIRE(a.met == b.met);
        REQUIRE((a.halvings == 0 && a.surface.size() + a.volume.size() == a.met));
        REQUIRE(b.halvings > 0);
        CHECK(b.surface.size() + b.volume.size() < 200);  // 100 expected at most
        difference.add(power(b) - power(a));
        relative.add(power(a));
    }
    CHECK(std::fabs(difference.z(0.0)) < critical_z);
    CHECK(std::fabs(difference.z(0.05 * relative.mean())) > critical_z);
}

TEST_CASE("No photon lies where direct light is sampled, unless requested", "[photons]") {
    const auto scene = foggy_scene();
    PhotonSettings settings;
    settings.paths.paths = 2000;
    PhotonSet set = trace_photons(*scene, settings, 1, 0, SamplerKind::sobol);
    for (const auto* photons : {&set.surface, &set.volume})
        for (const Photon& p : *photons) REQUIRE(p.depth >= 2);
    settings.first_in_medium = 1;
    set = trace_photons(*scene, settings, 1, 0, SamplerKind::sobol);
    CHECK(std::any_of(set.volume.begin(), set.volume.end(), [](const Photon& p) { return p.depth == 1; }));
    for (const Photon& p : set.surface) REQUIRE(p.depth >= 2);
}

TEST_CASE("Kernels shrink by the product that the passes would give one after the other", "[photons]") {
    for (const double alpha : {0.1, 2.0 / 3.0, 1.0}) {
        double r2 = 1.0;
        for (std::uint32_t pass = 0; pass < 1000; ++pass) {
            REQUIRE(radius_fraction(pass, alpha) == Approx(std::sqrt(r2)).epsilon(1e-9));
            r2 *= (double(pass) + 1.0 + alpha) / (double(pass) + 2.0);
        }
    }
}

TEST_CASE("Kernels of many light paths hold as many as those of few", "[photons]") {
    for (const int d : {1, 2, 3}) {
        CHECK(radius_for_paths(10.0, 1e4, d) == 1.0);
        for (const double n : {2e4, 1e6, 1e8})
            CHECK(n * std::pow(radius_for_paths(n, 1e4, d), d) == Approx(1e4).epsilon(1e-9));
    }
}
