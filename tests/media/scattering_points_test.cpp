// Scattering along a ray, all of it in one walk: candidates, and the points chosen among them, represent the
// integral of T sigma_s, the rest of the light comes through, and what the medium emits is met; whatever the
// medium.
#include "core/scene/scattering_points.h"
#include "core/scene/medium_state.h"
#include "media/homogeneous_medium.h"
#include "tests/media/test_media.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::tests;
using core::Ray, core::Rgb, core::Vec3, core::Vec3d;

namespace {

constexpr float no_chance = 1e-6f;  // ScatteringPoints::choose(): nothing is left out for being rare

/// Estimates of one ray: what scatters, the same times the distance, what comes through, what is emitted.
struct AlongRay {
    std::array<Mean, 3> scattered, distance, through, emitted;
    core::TrackingCounters counters;
};

AlongRay estimates(const core::Medium& medium, const Ray& ray, int points, int count,
                   float rare = no_chance) {
    AlongRay e;
    core::Rng rng(17);
    core::ScatteringPoints scattering(points);
    for (int i = 0; i < count; ++i) {
        core::PathWeights weights;
        Rgb emitted(0.0f), sum(0.0f), moment(0.0f);
        scattering.start(core::Rng(rng.next_u32()));
        scattering.begin_part({});
        medium.scatter_along(ray, weights, emitted, scattering, rng, e.counters);
        const auto chosen = scattering.choose(rare);
        REQUIRE((chosen.empty() || chosen.size() == std::size_t(points)));
        for (const core::ScatteringPoint& p : chosen)
            sum += p.weight, moment += p.weight * glm::distance(p.position, ray.origin);
        for (int c = 0; c < 3; ++c) {
            const auto k = std::size_t(c);
            e.scattered[k].add(sum[c]), e.distance[k].add(moment[c]);
            e.through[k].add(weights.throughput[c]), e.emitted[k].add(emitted[c]);
        }
    }
    return e;
}

/// Expectations by quadrature of the coefficients.
struct Exact {
    Vec3d scattered{0.0}, distance{0.0}, through{0.0}, emitted{0.0};
};

Exact quadrature(const core::Medium& medium, const Ray& ray, int steps) {
    Exact exact;
    Vec3d depth(0.0);
    const double h = (double(ray.t_max) - ray.t_min) / steps;
    for (int i = 0; i < steps; ++i) {
        const double t = ray.t_min + (i + 0.5) * h;
        const auto here = medium.coefficients(ray.at(float(t)));
        const Vec3d share = glm::exp(-(depth + 0.5 * h * Vec3d(here.sigma_t))) * h;
        exact.scattered += share * Vec3d(here.sigma_s), exact.distance += t * share * Vec3d(here.sigma_s);
        exact.emitted += share * Vec3d(here.emission), depth += h * Vec3d(here.sigma_t);
    }
    exact.through = glm::exp(-depth);
    return exact;
}

/// The largest deviation in standard errors from `scale` times the exact values; `scattering` false: of the
/// others.
double worst(const AlongRay& e, const Exact& exact, double scale = 1.0, bool scattering = true) {
    double sigmas = 0.0;
    for (int c = 0; c < 3; ++c) {
        const auto k = std::size_t(c);
        sigmas = std::max({sigmas, e.through[k].sigmas_from(scale * exact.through[c], 2e-4),
                           e.emitted[k].sigmas_from(scale * exact.emitted[c], 2e-4)});
        if (scattering)
            sigmas = std::max({sigmas, e.scattered[k].sigmas_from(scale * exact.scattered[c], 2e-4),
                               e.distance[k].sigmas_from(scale * exact.distance[c], 2e-4)});
    }
    return sigmas;
}

void check(const core::Medium& medium, const Ray& ray, int count, int steps, const std::string& name) {
    const Exact exact = quadrature(medium, ray, steps);
    for (const int points : {0, 1, 5}) {
        INFO(name << ", " << points << " points");
        const auto e = estimates(medium, ray, points, count);
        CHECK(worst(e, exact, 1.0, points > 0) < 4.5);
        CHECK(worst(e, exact, 1.05, points > 0) > 4.5);
        CHECK(e.counters.fallbacks == 0);
    }
    INFO(name << ", most of them left out");
    CHECK(worst(estimates(medium, ray, 3, count, 3.0f), exact) < 4.5);
}

media::HomogeneousMedium homogeneous(const Rgb& sigma_t, const Rgb& albedo, const Rgb& glow = Rgb(0.0f)) {
    return {sigma_t, albedo * sigma_t, glow, std::make_shared<media::IsotropicPhase>()};
}

/// A medium that overrides nothing.
class Plain final : public core::Medium {
  public:
    explicit Plain(const core::Medium& medium) : medium_(medium) {}
    core::MediumTraits traits() const override { return medium_.traits(); }
    const core::PhaseFunction& phase() const override { return medium_.phase(); }
    core::MediumCoefficients coefficients(const Vec3& p) const override { return medium_.coefficients(p); }
    float majorant() const override { return medium_.majorant(); }
    core::Bounds3 bounds() const override { return medium_.bounds(); }
    std::optional<float> sample_collision(const Ray& ray, core::PathWeights& weights, Rgb& emitted,
                                          core::Rng& rng, core::TrackingCounters& counters) const override {
        return medium_.sample_collision(ray, weights, emitted, rng, counters);
    }
    void connect(const Ray& ray, core::PathWeights& weights, core::Rng& rng,
                 core::TrackingCounters& counters) const override {
        medium_.connect(ray, weights, rng, counters);
    }
    Rgb transmittance(const Ray& ray, core::Rng& rng, core::TrackingCounters& counters) const override {
        return medium_.transmittance(ray, rng, counters);
    }

  private:
    const core::Medium& medium_;
};

const Ray along_x{Vec3(0.0f), Vec3(1, 0, 0), 0.2f, 1.7f};
const Ray through_grid{Vec3(-0.2f, 0.3f, 0.4f), glm::normalize(Vec3(1.0f, 0.25f, 0.1f)), 0.1f, 1.5f};

std::shared_ptr<media::HeterogeneousMedium> grid(int channels, float scale, bool glows = false) {
    auto parts = medium_parts(Rgb(0.9f, 0.6f, 0.3f), scale);
    if (glows) parts.emission.radiance = std::make_shared<media::ConstantVolume>(Rgb(1.0f, 2.0f, 3.0f));
    return medium_of(random_grid(glm::ivec3(20), channels, 5), parts);
}

}  // namespace

TEST_CASE("scattering points of a homogeneous slab are the closed form", "[media][scattering_points]") {
    for (const float sigma : {1e-4f, 0.7f, 30.0f}) {
        const auto e = estimates(homogeneous(Rgb(sigma), Rgb(0.8f)), along_x, 4, 2);
        const double through = std::exp(-double(sigma) * 1.5);
        CHECK(e.scattered[0].value() == Approx(0.8 * (1.0 - through)).epsilon(2e-6));
        CHECK(e.scattered[0].standard_error() < 1e-6);  // grey: nothing is left to chance
        CHECK(e.through[0].value() == Approx(through).epsilon(1e-6).margin(1e-12));
    }
    check(homogeneous(Rgb(0.7f), Rgb(0.8f, 0.5f, 0.0f)), along_x, 20000, 4000, "grey");
    check(homogeneous({0.3f, 1.0f, 4.0f}, Rgb(0.8f, 0.9f, 1.0f), Rgb(1.0f)), along_x, 60000, 4000,
          "coloured");
    check(homogeneous({0.0f, 1.0f, 4.0f}, Rgb(0.8f)), along_x, 60000, 4000, "clear in one channel");
    check(Plain(homogeneous({0.3f, 1.0f, 4.0f}, Rgb(0.8f), Rgb(1.0f))), along_x, 100000, 4000,
          "by collisions");
    const Ray endless{Vec3(0.0f), Vec3(1, 0, 0)};
    const auto e = estimates(homogeneous({0.0f, 1.0f, 4.0f}, Rgb(0.8f)), endless, 4, 20000);
    CHECK(e.through[0].value() == 1.0);
    CHECK((e.through[1].value() == 0.0 && e.scattered[0].value() == 0.0));
    for (const std::size_t c : {1u, 2u}) CHECK(e.scattered[c].sigmas_from(0.8, 1e-5) < 4.5);
}

TEST_CASE("a medium that only absorbs has no scattering points", "[media][scattering_points]") {
    const auto e = estimates(homogeneous({0.3f, 1.0f, 4.0f}, Rgb(0.0f)), along_x, 4, 2);
    CHECK(e.through[1].value() == Approx(std::exp(-1.5)));
    CHECK(e.scattered[1].value() == 0.0);
    const auto m = medium_of(random_grid(glm::ivec3(20), 1, 5), medium_parts(Rgb(0.0f), 2.0f));
    const auto g = estimates(*m, through_grid, 4, 20000);
    CHECK(worst(g, quadrature(*m, through_grid, 4000)) < 4.5);
    CHECK(g.scattered[0].value() == 0.0);
}

TEST_CASE("scattering points in grids have the mean of quadrature", "[media][scattering_points]") {
    check(*grid(1, 1.0f), through_grid, 20000, 4000, "grey");
    check(*grid(1, 0.01f), through_grid, 20000, 4000, "thin");
    check(*grid(3, 3.0f, true), through_grid, 30000, 4000, "coloured and glowing");
    check(*grid(1, 3.0f), through_grid, 40000, 4000, "dense");
    auto parts = medium_parts(Rgb(0.8f));
    parts.plant_majorant_factor = 3.0f;
    check(*medium_of(random_grid(glm::ivec3(20), 1, 7), parts), through_grid, 20000, 4000, "loose majorants");
    parts.plant_majorant_factor = 0.3f;
    const auto wrong = medium_of(random_grid(glm::ivec3(20), 1, 7), parts);
    CHECK(worst(estimates(*wrong, through_grid, 8, 20000), quadrature(*wrong, through_grid, 4000)) > 4.5);
}

TEST_CASE("scattering points beside voxels far denser than the rest", "[media][scattering_points][regular]") {
    for (const int channels : {1, 3}) {
        auto with_light = medium_parts(Rgb(0.8f));
        with_light.emission.radiance = std::make_shared<media::ConstantVolume>(Rgb(1.0f, 2.0f, 3.0f));
        check(*medium_of(hot_grid(channels, 1e4f), with_light), past_hot, 30000, 20000,
              channels == 1 ? "hot" : "hot in colours");
    }
}

TEST_CASE("more points are less noise than one collision by chance", "[media][scattering_points]") {
    const auto m = grid(1, 0.3f);
    const auto tossed = estimates(Plain(*m), through_grid, 1, 20000),
               one = estimates(*m, through_grid, 1, 20000), eight = estimates(*m, through_grid, 8, 20000);
    const auto variance = [](const AlongRay& e) { return core::sqr(e.distance[0].standard_error()); };
    CHECK(variance(one) < 0.5 * variance(tossed));
    CHECK(variance(eight) < 0.2 * variance(one));
}

TEST_CASE("too many candidates to keep leave their mean", "[media][scattering_points]") {
    core::Rng rng(3);
    core::ScatteringPoints points(2);
    Mean position, sum;
    for (int i = 0; i < 4000; ++i) {
        points.start(core::Rng(rng.next_u32()));
        points.begin_part({});
        // 5000 candidates at x = 0 to 1 of weight x: the sum is 1/2, the mean of x by weight is 2/3.
        double total = 0.0, moment = 0.0;
        for (int k = 0; k < 5000; ++k) {
            const float x = (float(k) + 0.5f) / 5000.0f;
            points.add(Vec3(x, 0, 0), Rgb(x / 5000.0f));
        }
        for (const auto& p : points.choose(no_chance))
            total += p.weight.x, moment += p.weight.x * p.position.x;
        sum.add(total), position.add(moment);
    }
    CHECK(sum.sigmas_from(0.5, 1e-4) < 4.5);
    CHECK(position.sigmas_from(1.0 / 3.0, 1e-4) < 4.5);
    CHECK(position.sigmas_from(1.02 / 3.0, 1e-4) > 4.5);
}
