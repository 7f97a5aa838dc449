// Every selection of virtual point lights over the callbacks of another renderer's scene: lightcuts,
// stochastic lightcuts, the light tree, resampling, matrix rows and columns. The scene is examples/room.h,
// whose light is known.
#include <mote/core/objects/properties.h>
#include <mote/lights/selection/register_selection.h>
#include <mote/lights/virtual_lights/particle_tracer.h>

#include <cstdio>

#include "../room.h"

using namespace mote;

room::Receivers::Mean gathered(const room::Room& room, const lights::VplSet& vpls,
                               const lights::Selection& selection) {
    room::Receivers receivers{room};
    core::Rng rng(5);
    core::Statistics statistics;
    std::vector<lights::PathReceiver> samples;  // those that prepare() learns from
    for (std::size_t i = 0; i < selection.receiver_paths(); ++i)
        samples.push_back({room.vertex(rng), core::Rgb(1.0f), {}, 1000});
    const lights::VplSelector make = selection.prepare({room.scene,
                                                        vpls,
                                                        core::infinity,
                                                        1,
                                                        receivers.walk.rays,
                                                        receivers.walk.tracking,
                                                        statistics,
                                                        {},
                                                        samples});
    const auto selector = make();  // of one thread
    return receivers.irradiance([&](const auto&, lights::ReceiverTile& tile, core::Rng& random) {
        const lights::GatherContext context = receivers.context();
        lights::TracedVisibility visibility(context, tile);
        lights::TileLight light = selector->gather(context, tile, {}, visibility, random);
        // Selections that gather several receivers together only copy them before.
        const auto copied =
            selector->gather_copied(context, random)[std::size_t(lights::ReceiverKind::surface)];
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += copied[i];
        return light;
    });
}

int main() {
    const room::Room room;
    const auto vpls = lights::trace_light_paths(room.scene, {.paths = 2048}, 1, 0, core::SamplerKind::sobol);
    core::Registry registry;
    lights::register_selection(registry);
    int wrong = 0;
    for (const char* type :
         {"all", "uniform", "lightcuts", "stochastic_lightcuts", "light_tree", "resampling", "matrix"}) {
        core::Properties properties;  // all settings at their defaults; properties.values holds others
        properties.category = core::Category::selection, properties.type = type;
        const auto selection = std::dynamic_pointer_cast<const lights::Selection>(registry.make(properties));
        const auto [found, error] = gathered(room, vpls, *selection);
        const double expected = room::all_light - room::direct;
        std::printf("%-22s %.3f +- %.3f W/m^2 by bounces, %.3f by energy\n", type, found, error, expected);
        // One set of light paths, and the 2 % by which lightcuts may err, besides the noise of the receivers.
        wrong += std::fabs(found - expected) > 4.0 * error + 0.02 * expected;
    }
    return wrong;
}
