// Emission against direct sampling: the two halves of a light were written apart and must describe one light.
#include "tests/lights/emitter_examples.h"
#include "tests/lights/emitter_statistics.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

constexpr int particles = 400000, connections = 20000;
// Large enough to catch particles, tilted so that cosines matter, off the lights' axes.
const Patch patch{Vec3(0.1f, -0.1f, 0.0f), glm::normalize(Vec3(0.2f, -0.1f, 1.0f)), 0.6f};

/// Passes everything on, with the weights of particles or of connections multiplied.
class PlantedError final : public Emitter {
  public:
    PlantedError(std::shared_ptr<Emitter> light, float direct, float emission)
        : light_(std::move(light)), direct_(direct), emission_(emission) {}
    EmitterTraits traits() const override { return light_->traits(); }
    std::optional<DirectSample> sample_direct(const Vec3& p, const Vec2& u) const override {
        auto s = light_->sample_direct(p, u);
        if (s) s->weight *= direct_;
        return s;
    }
    float pdf_direct(const Vec3& p, const Vec3& wi, const SurfaceHit* hit) const override {
        return light_->pdf_direct(p, wi, hit);
    }
    std::optional<EmissionSample> sample_emission(const Vec2& a, const Vec2& b) const override {
        auto s = light_->sample_emission(a, b);
        if (s) s->weight *= emission_;
        return s;
    }
    EmissionDensity pdf_emission(const Vec3& origin, const Vec3& normal,
                                 const Vec3& direction) const override {
        return light_->pdf_emission(origin, normal, direction);
    }
    Rgb power() const override { return light_->power(); }

  private:
    std::shared_ptr<Emitter> light_;
    float direct_, emission_;
};

}  // namespace

TEST_CASE("particles through a disk carry the flux that direct sampling finds", "[lights][emitters]") {
    for (const auto& example : light_examples()) {
        INFO(example.name);
        const MeanRgb direct = flux_by_direct_sampling(*example.light, patch, connections);
        const MeanRgb traced = flux_by_particles(*example.light, patch, particles);
        for (int c = 0; c < 3; ++c) {
            INFO("channel " << c << ": direct " << direct.channel[c].value() << " +- "
                            << direct.channel[c].error() << ", particles " << traced.channel[c].value()
                            << " +- " << traced.channel[c].error());
            CHECK(direct.channel[c].value() > 0.0);
            CHECK(agree(direct.channel[c], traced.channel[c]));
            // The test has power: both estimates together are good to a percent.
            CHECK(std::hypot(direct.channel[c].error(), traced.channel[c].error()) <
                  0.02 * direct.channel[c].value());
        }
    }
}

TEST_CASE("the mean particle carries the power of the light", "[lights][emitters]") {
    for (const auto& example : light_examples()) {
        INFO(example.name);
        const MeanRgb mean = particle_power(*example.light, 100000);
        const Rgb power = example.light->power();
        INFO(power.x << ' ' << power.y << ' ' << power.z << " against " << mean.channel[0].value() << ' '
                     << mean.channel[1].value() << ' ' << mean.channel[2].value());
        // A textured spot's power is a quadrature with 64^2 points.
        CHECK(agree(mean, power, example.name == "textured spot" ? 0.01 : 1e-5));
    }
}

TEST_CASE("particles start where their densities say", "[lights][emitters]") {
    for (const auto& example : light_examples()) {
        INFO(example.name);
        const auto traits = example.light->traits();
        Rng rng(11);
        int started = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec2 u_position = rng.next_vec2();
            const auto s = example.light->sample_emission(u_position, rng.next_vec2());
            if (!s) continue;
            ++started;
            REQUIRE(std::fabs(glm::length(s->direction) - 1.0f) < 1e-5f);
            REQUIRE(s->pdf_area > 0.0f);
            REQUIRE(s->pdf_solid_angle > 0.0f);
            REQUIRE(is_finite(s->weight));
            REQUIRE(s->shape == example.shape.get());
            if (traits.delta_position) REQUIRE(s->pdf_area == 1.0f);
            if (traits.delta_direction) REQUIRE(s->pdf_solid_angle == 1.0f);
            if (traits.infinite) {
                // The disk touches the sphere from outside, and the particle crosses it.
                const Vec3 from_center = s->origin - Vec3(0, 0, 1);
                REQUIRE(glm::length(from_center) >= 3.0f);
                REQUIRE(-glm::dot(from_center, s->direction) >= 3.0f);
                REQUIRE(glm::length(glm::cross(from_center, s->direction)) <= 3.01f);
            }
            if (example.shape) {
                REQUIRE(glm::dot(s->normal, s->direction) > 0.0f);
                REQUIRE(std::fabs(s->pdf_area * example.shape->area() - 1.0f) < 1e-3f);
                REQUIRE(std::fabs(s->pdf_solid_angle * pi - glm::dot(s->normal, s->direction)) < 1e-4f);
            }
        }
        CHECK(started > 100);
    }
}

TEST_CASE("planted errors of emission are caught", "[lights][emitters]") {
    const auto light = mote::lights::make_point_light({0.5, 0.2, 1.0}, Rgb(1.0f));
    // The standard error of both together is below 0.3 %: two per cent is more than six of them.
    const auto flux_agrees = [](const Emitter& e) {
        return agree(flux_by_direct_sampling(e, patch, 400000), flux_by_particles(e, patch, 3000000));
    };
    CHECK(flux_agrees(PlantedError(light, 1.0f, 1.0f)));
    CHECK_FALSE(flux_agrees(PlantedError(light, 1.02f, 1.0f)));
    CHECK_FALSE(flux_agrees(PlantedError(light, 1.0f, 0.98f)));
    const PlantedError two_percent(light, 1.0f, 1.02f);
    CHECK_FALSE(agree(particle_power(two_percent, 1000), two_percent.power()));
}

TEST_CASE("powers 1e18 apart stay exact", "[lights][emitters]") {
    for (const float scale : {1e-6f, 1.0f, 1e12f}) {
        const Rgb intensity = scale * Rgb(3, 2, 1);
        const auto point = mote::lights::make_point_light({0, 0, 2}, intensity);
        CHECK(agree(particle_power(*point, 100), 4.0f * pi * intensity));
        CHECK(agree(irradiance(*point, Vec3(0), Vec3(0, 0, 1), 10), 0.25f * intensity));
        const auto sky = mote::lights::make_environment_map(sky_picture(), {}, scale);
        CHECK(agree(particle_power(*sky, 20000), sky->power()));
    }
}
