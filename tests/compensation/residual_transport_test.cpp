// One step of the residual transport against quadrature of Eq. 10.11, for every way to place a vertex; and
// the light that must not be in it.
#include "compensation/residual_transport.h"

#include <fmt/format.h>

#include "compensation/light_compensation.h"
#include "media/phase_functions.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::compensation;
using namespace mote::tests;
using core::Rgb, core::Vec3;

namespace {

/// A ball of fog of radius 10 with a lamp far away.
std::string ball_of_fog(const std::string& sigma_t) {
    return fmt::format(R"(<scene version="3.0.0">
        <shape type="sphere"><float name="radius" value="10"/><bsdf type="null"/>
            <medium type="homogeneous" name="interior"><rgb name="sigma_t" value="{}"/><rgb name="albedo" value="0.9, 0.5, 0.2"/></medium></shape>
        <emitter type="point"><point name="position" x="0" y="50" z="0"/></emitter><sensor type="perspective"/></scene>)",
                       sigma_t);
}

/// integral over t of sigma_s e^(-sigma_t t) B*(t) up to the radius; f* over its density is one.
double expected_weight(double sigma_t, double albedo, double bound) {
    const double radius = 1.0 / std::sqrt(bound);
    double sum = 0.0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        const double t = (i + 0.5) * radius / n;
        sum += albedo * sigma_t * std::exp(-sigma_t * t) * (1.0 - bound * t * t) * radius / n;
    }
    return sum;
}

struct Measured {
    core::Vec3d mean{0.0}, error{0.0};
};

Measured measure(const core::Scene& scene, const ResidualTransport& transport, int samples) {
    core::ScatteringVertex receiver;
    static const media::IsotropicPhase isotropic;
    receiver.position = Vec3(0.2f, -0.1f, 0.3f), receiver.wo = Vec3(0, 0, 1), receiver.phase = &isotropic;
    const core::MediumState state = scene.medium_state_at(receiver.position, nullptr);
    core::WalkContext context;
    context.rng = core::Rng(5);
    core::Vec3d sum(0.0), squares(0.0);
    for (int i = 0; i < samples; ++i) {
        ResidualPath path = transport.start(receiver, state, Rgb(1.0f), context.rng);
        if (!transport.step<true>(path, context)) continue;
        const core::Vec3d w(path.throughput());
        sum += w, squares += w * w;
    }
    const core::Vec3d mean = sum / double(samples);
    return {mean, glm::sqrt((squares / double(samples) - mean * mean) / double(samples))};
}

}  // namespace

TEST_CASE("a step has the weight of Eq. 10.11, however its vertex is placed", "[compensation][step]") {
    for (const char* sigma : {"1, 1, 1", "0.02, 0.5, 4"}) {
        const auto scene = scene_from(ball_of_fog(sigma));
        const Rgb sigma_t = scene->media().front()->coefficients(Vec3(0.0f)).sigma_t;
        for (const Placement placement : {Placement::free_path, Placement::in_region})
            for (const LocalTransmittance t : {LocalTransmittance::exact, LocalTransmittance::mean})
                for (const bool look : {true, false}) {
                    CompensationSettings settings;
                    settings.placement = placement;
                    settings.transmittance = t, settings.local_visibility = look;
                    const ResidualTransport transport(*scene, 0.25f, settings);
                    CHECK(transport.radius() == 2.0f);
                    const Measured m = measure(*scene, transport, 100000);
                    const double albedo[3] = {0.9, 0.5, 0.2};
                    for (int c = 0; c < 3; ++c) {
                        const double expected = expected_weight(double(sigma_t[c]), albedo[c], 0.25);
                        INFO(sigma << " channel " << c << " placement " << int(placement) << " transmittance "
                                   << int(t) << " look " << look << ": " << m.mean[c] << " +- " << m.error[c]
                                   << ", expected " << expected);
                        // 48 comparisons at 4 standard errors: false alarms in 0.3 % of all runs.
                        CHECK(std::fabs(m.mean[c] - expected) < 4.0 * m.error[c]);
                        CHECK(m.error[c] < 0.03 * expected);
                        // Another bound would be found, except where light hardly gets to the edge.
                        if (sigma_t[c] <= 1.0f)
                            CHECK(std::fabs(m.mean[c] - expected_weight(double(sigma_t[c]), albedo[c], 0.5)) >
                                  4.0 * m.error[c]);
                    }
                }
    }
}

TEST_CASE("no compensation where the bound takes nothing", "[compensation][step]") {
    const auto scene = scene_from(ball_of_fog("1, 1, 1"));
    CompensationSettings settings;
    CHECK(measure(*scene, ResidualTransport(*scene, 1e12f, settings), 2000).mean.x < 1e-4);
    settings.placement = Placement::in_region;
    CHECK(measure(*scene, ResidualTransport(*scene, 1e30f, settings), 2000).mean.x < 1e-4);
    // With a tiny bound everything is residual: the weight is the albedo of a ball without end.
    settings.placement = Placement::free_path;
    CHECK(measure(*scene, ResidualTransport(*scene, 1e-12f, settings), 20000).mean.x ==
          Approx(0.9).epsilon(0.02));
}

TEST_CASE("light emitted inside the region is direct light, not compensation", "[compensation][step]") {
    // A black lamp just in front of a wall: it reflects nothing, so nothing is to be compensated.
    const auto scene = scene_from(R"(<scene version="3.0.0">
        <shape type="rectangle"><bsdf type="diffuse"/></shape>
        <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/><translate z="0.2"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf><emitter type="area"/></shape>
        <sensor type="perspective"/></scene>)");
    CompensationSettings settings;
    const ResidualTransport transport(*scene, 1.0f, settings);
    core::WalkContext context;
    const core::Ray ray{Vec3(0.1f, 0.1f, 0.1f), Vec3(0, 0, -1)};
    const auto hit = scene->rays().closest(ray);
    REQUIRE(hit);
    core::WalkEvent event;
    event.kind = core::WalkEvent::Kind::surface, event.hit = *hit, event.distance = hit->t;
    const core::ScatteringVertex wall = core::make_vertex(event, ray);
    std::uint64_t vertices = 0;
    Rgb sum(0.0f);
    for (int i = 0; i < 2000; ++i)
        sum += compensation_from_lights<false>(
            *scene, transport, transport.start(wall, {}, Rgb(1.0f), context.rng), -1, context, vertices);
    CHECK(core::max_component(sum) == 0.0f);
    // A lamp that reflects half of it does return light to the wall: it is the wall's own light that it
    // reflects.
    const auto grey = scene_from(R"(<scene version="3.0.0">
        <shape type="rectangle"><bsdf type="diffuse"/></shape>
        <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/><translate z="0.2"/></transform>
            <bsdf type="diffuse"/><emitter type="area"/></shape>
        <sensor type="perspective"/></scene>)");
    const ResidualTransport second(*grey, 1.0f, settings);
    const auto grey_hit = grey->rays().closest(ray);
    event.hit = *grey_hit;
    const core::ScatteringVertex grey_wall = core::make_vertex(event, ray);
    for (int i = 0; i < 200; ++i)
        sum += compensation_from_lights<false>(
            *grey, second, second.start(grey_wall, {}, Rgb(1.0f), context.rng), 2, context, vertices);
    CHECK(core::max_component(sum) > 0.0f);
}
