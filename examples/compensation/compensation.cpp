// Compensation of the light that a bound on the geometry term takes from virtual point lights, over the
// callbacks of another renderer's scene (examples/room.h, whose light is known): approximately by one step of
// the residual transport, exactly by all.
#include <mote/compensation/light_compensation.h>
#include <mote/compensation/vpl_compensation.h>
#include <mote/lights/virtual_lights/particle_tracer.h>

#include <cstdio>

#include "../room.h"

using namespace mote;

constexpr float bound = 4.0f;  // [1/m^2]

/// Gathers with the bound, and adds what it takes by so many steps (-1: all of them).
room::Receivers::Mean gathered(const room::Room& room, const lights::VplSet& vpls, int steps) {
    room::Receivers receivers{room};
    const compensation::ResidualTransport transport(room.scene, bound, {});
    compensation::VplCompensationScratch scratch;
    return receivers.irradiance([&](const auto& vertices, lights::ReceiverTile& tile, core::Rng& rng) {
        const lights::GatherContext context = receivers.context();
        core::WalkContext& walk = receivers.walk;
        auto light = lights::gather(context, vpls, lights::VplRange{}, lights::BoundedGeometry{bound}, tile);
        if (steps == 0) return light;
        compensation::CompensatedTile tile_of_paths;
        for (std::size_t i = 0; i < light.size(); ++i) {
            const auto path = transport.start(vertices[i], {}, core::Rgb(1.0f), walk.rng);
            tile_of_paths[i] = {path, core::Rng(rng.next_u32()), 1000};
            // The vertex that a step finds reflects the light of the lamps ...
            light[i] += compensation::compensation_from_lights<false>(room.scene, transport, path, steps,
                                                                      walk, scratch.vertices);
        }
        // ... and that of the virtual point lights.
        const auto more = compensation::compensation_from_vpls<false>(
            {transport, compensation::Strategy::one_to_n, steps, vpls, {}}, tile_of_paths, scratch, context,
            walk);
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += more[i];
        return light;
    });
}

int main() {
    const room::Room room;
    const auto vpls = lights::trace_light_paths(room.scene, {.paths = 512}, 1, 0, core::SamplerKind::sobol);
    const double expected = room::all_light - room::direct;
    const auto off = [&](const char* name, int steps) {
        const auto [found, error] = gathered(room, vpls, steps);
        std::printf("%-16s %.3f +- %.3f W/m^2 by bounces, %.3f by energy\n", name, found, error, expected);
        return std::fabs(found - expected) / (4.0 * error + 0.01 * expected);
    };
    const double without = off("bounded", 0), approximate = off("one step", 1), exact = off("every step", -1);
    return without > 1.0 && approximate < without && exact < 1.0 ? 0 : 1;
}
