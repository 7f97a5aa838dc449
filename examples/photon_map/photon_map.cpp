// Photon maps over the callbacks of another renderer's scene (examples/room.h, whose light is known): the
// radiance that walls reflect, estimated from the nearest photons.
#include <mote/gathering/photon_maps/photon_tracer.h>
#include <mote/gathering/photon_maps/surface_photon_map.h>

#include <cmath>
#include <cstdio>

#include "../room.h"

using namespace mote;

int main() {
    const room::Room room;
    gathering::PhotonSettings settings;
    settings.paths.paths = 50000;
    settings.first_on_surface = 1;  // direct light by photons too
    const gathering::PhotonSet photons =
        gathering::trace_photons(room.scene, settings, 1, 0, core::SamplerKind::sobol);
    const gathering::SurfacePhotonMap map(photons.surface);

    core::Rng rng(7);
    std::vector<core::KdTree::Neighbour> scratch;
    const int receivers = 4000;
    double irradiance = 0.0;
    int counted = 0;
    while (counted < receivers) {
        const core::ScatteringVertex vertex = room.vertex(rng);
        // Near an edge a part of the disc lies beyond the wall, and the estimate is too dark.
        int near = 0;
        for (int axis = 0; axis < 3; ++axis) near += std::fabs(vertex.position[axis] - 0.5f) > 0.4f;
        if (near > 1) continue;
        ++counted;
        const core::Rgb radiance = map.radiance(vertex, {.neighbours = 50}, 65535, scratch);
        irradiance += double(radiance.x * core::pi / room::reflectance) / receivers;
    }
    // The middles of walls receive more than their mean: direct light falls off towards edges.
    std::printf("%zu photons: the middles of the walls receive %.3f W/m^2, all walls %.3f by energy\n",
                map.size(), irradiance, room::all_light);
    double brought = 0.0;
    for (const gathering::Photon& photon : map.photons()) brought += double(photon.power.x);
    std::printf("photons bring %.3f W/m^2\n", brought / room::area);
    return std::fabs(brought / room::area / room::all_light - 1.0) < 0.02 && irradiance > room::all_light &&
                   irradiance < 1.3 * room::all_light
               ? 0
               : 1;
}
