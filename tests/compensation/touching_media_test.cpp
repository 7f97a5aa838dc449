// Steps of the residual transport where two media touch: light of both counts, and the extinction of neither
// counts twice.
#include <fmt/format.h>

#include "compensation/residual_transport.h"
#include "media/phase_functions.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::compensation;
using namespace mote::tests;

namespace {

constexpr float bound = 0.25f;  // a radius of 2

std::string block(float from, float to) {
    return fmt::format(
        R"(<shape type="cube"><transform name="to_world"><scale x="{}" y="10" z="10"/><translate x="{}"/></transform>
            <bsdf type="null"/><medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.7"/>
            <rgb name="albedo" value="0.9"/></medium></shape>)",
        0.5f * (to - from), 0.5f * (to + from));
}

auto scene_of(const std::string& blocks) {
    return scene_from("<scene version='3.0.0'>" + blocks +
                      "<emitter type='point'><point name='position' x='0' y='50' z='0'/></emitter><sensor "
                      "type='perspective'/></scene>");
}

struct Weight {
    double mean, error;
};

/// Mean weight of a step from a point at distance `x` from the face where the blocks touch.
Weight weight_of_step(const core::Scene& scene, float x, const CompensationSettings& settings) {
    const ResidualTransport transport(scene, bound, settings);
    static const media::IsotropicPhase isotropic;
    core::ScatteringVertex receiver;
    receiver.position = {x, 0.1f, 0.2f}, receiver.wo = {0, 0, 1}, receiver.phase = &isotropic;
    const core::MediumState state = scene.medium_state_at(receiver.position, nullptr);
    core::WalkContext context;
    context.rng = core::Rng(7);
    constexpr int samples = 40000;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < samples; ++i) {
        ResidualPath path = transport.start(receiver, state, core::Rgb(1.0f), context.rng);
        if (!transport.step<true>(path, context)) continue;
        const double w = path.throughput().x;
        sum += w, squares += w * w;
    }
    const double mean = sum / samples;
    return {mean, std::sqrt((squares / samples - mean * mean) / samples)};
}

}  // namespace

TEST_CASE("Two blocks of fog that touch count as one block of the same fog", "[compensation][step]") {
    const auto one = scene_of(block(-10, 10)), two = scene_of(block(-10, 0) + block(0, 10));
    for (const float x : {-0.3f, 0.4f})
        for (const Placement placement : {Placement::free_path, Placement::in_region})
            for (const LocalTransmittance transmittance :
                 {LocalTransmittance::exact, LocalTransmittance::mean})
                for (const bool look : {true, false}) {
                    CompensationSettings settings;
                    settings.placement = placement;
                    settings.transmittance = transmittance, settings.local_visibility = look;
                    const Weight expected = weight_of_step(*one, x, settings);
                    const Weight found = weight_of_step(*two, x, settings);
                    INFO("x " << x << " placement " << int(placement) << " transmittance "
                              << int(transmittance) << " look " << look << ": " << found.mean << " +- "
                              << found.error << ", one block " << expected.mean);
                    // 16 comparisons at 4 standard errors: false alarms in 0.1 % of all runs.
                    CHECK(std::fabs(found.mean - expected.mean) <
                          4.0 * std::hypot(found.error, expected.error));
                    CHECK(expected.mean > 0.3);
                }
}
