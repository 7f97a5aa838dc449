// Every selection of virtual point lights over the callbacks of another renderer's scene (lightcuts,
// stochastic lightcuts, the light tree, resampling, matrix rows and columns), and what a bound on the
// geometry term takes, brought back exactly and approximately. The scene is examples/room.h, whose light is
// known.
#include <mote/compensation/vpl_compensation.h>
#include <mote/core/objects/properties.h>
#include <mote/lights/selection/register_selection.h>
#include <mote/lights/virtual_lights/particle_tracer.h>

#include <cmath>
#include <cstdio>

#include "../room.h"

using namespace mote;
using lights::TileLight;

constexpr int tiles = 200, lanes = lights::ReceiverLanes::width;

struct Gatherer {
    const room::Room& room;
    const lights::VplSet& vpls;
    lights::GatherScratch scratch = {};
    core::WalkContext walk = {};  // counts rays

    lights::GatherContext context() { return {room.scene, scratch, walk.rays, walk.tracking}; }
    /// Mean irradiance by bounces [W/m^2]; `light` gives what sixteen receivers reflect.
    template <typename Light>
    double irradiance(const Light& light) {
        core::Rng rng(7);
        double sum = 0.0;
        for (int i = 0; i < tiles; ++i) {
            std::array<core::ScatteringVertex, lanes> vertices;
            lights::ReceiverTile tile;
            for (int lane = 0; lane < lanes; ++lane) {
                vertices[std::size_t(lane)] = room.vertex(rng);
                tile.set(lane, vertices[std::size_t(lane)], core::Rgb(1.0f), {}, rng, 1000);
            }
            for (const core::Rgb& l : light(vertices, tile, rng)) sum += double(l.x) / (tiles * lanes);
        }
        return sum * double(core::pi / room::reflectance);
    }
};

double selected(Gatherer& g, const lights::Selection& selection) {
    core::Rng rng(5);
    core::Statistics statistics;
    std::vector<lights::PathReceiver> receivers;  // those that prepare() learns from
    for (std::size_t i = 0; i < selection.receiver_paths(); ++i)
        receivers.push_back({g.room.vertex(rng), core::Rgb(1.0f), {}, 1000});
    const lights::VplSelector make = selection.prepare(
        {g.room.scene, g.vpls, core::infinity, 1, g.walk.rays, g.walk.tracking, statistics, {}, receivers});
    const auto selector = make();
    return g.irradiance([&](const auto&, lights::ReceiverTile& tile, core::Rng& random) {
        const lights::GatherContext context = g.context();
        lights::TracedVisibility visibility(context, tile);
        return selector->gather(context, tile, {}, visibility, random);
    });
}

/// Gathers with the bound, and adds what it takes by `steps` steps of the residual transport (-1: all of
/// them).
double compensated(Gatherer& g, float bound, int steps) {
    const compensation::ResidualTransport transport(g.room.scene, bound, {});
    const auto scratch = std::make_unique<compensation::VplCompensationScratch>();
    return g.irradiance([&](const auto& vertices, lights::ReceiverTile& tile, core::Rng& rng) {
        compensation::CompensatedTile receivers;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            receivers[i].rng = core::Rng(rng.next_u32());
            receivers[i].path = transport.start(vertices[i], {}, core::Rgb(1.0f), receivers[i].rng);
            receivers[i].max_vpl_depth = 1000;
        }
        TileLight light =
            lights::gather(g.context(), g.vpls, lights::VplRange{}, lights::BoundedGeometry{bound}, tile);
        if (steps == 0) return light;
        const TileLight more = compensation::compensation_from_vpls<false>(
            {transport, compensation::Strategy::one_to_n, steps, g.vpls, {}}, receivers, *scratch,
            g.context(), g.walk);
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += more[i];
        return light;
    });
}

int main() {
    const room::Room room;
    const auto vpls = lights::trace_light_paths(room.scene, {.paths = 2048}, 1, 0, core::SamplerKind::sobol);
    Gatherer gatherer{room, vpls};
    const double expected = room::all_light - room::direct;
    int wrong = 0;
    const auto report = [&](const char* name, double found, double tolerance) {
        const double off = found / expected - 1.0;
        std::printf("%-22s %+.2f %%\n", name, 100.0 * off);
        wrong += std::fabs(off) > tolerance;
    };
    core::Registry registry;
    lights::register_selection(registry);
    for (const char* type :
         {"all", "uniform", "lightcuts", "stochastic_lightcuts", "light_tree", "resampling", "matrix"}) {
        const auto selection = std::dynamic_pointer_cast<const lights::Selection>(registry.factory(
            core::Category::selection, type)(core::Properties{core::Category::selection, type}));
        report(type, selected(gatherer, *selection), 0.04);
    }
    report("bound, no compensation", compensated(gatherer, 4.0f, 0), 0.5);
    report("bound, one step", compensated(gatherer, 4.0f, 1), 0.1);
    report("bound, every step", compensated(gatherer, 4.0f, -1), 0.04);
    return wrong;
}
