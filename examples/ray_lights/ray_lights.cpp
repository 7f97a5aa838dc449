// Virtual ray lights over the callbacks of another renderer's scene: the room of examples/room.h, filled with
// fog that scatters all light. Fog then changes nothing about what the walls receive in all: the power of the
// lamp ends in the walls, and only there.
#include <mote/lights/ray_lights/line_gather.h>
#include <mote/media/homogeneous_medium.h>
#include <mote/media/phase_functions.h>

#include <algorithm>
#include <cstdio>

#include "../room.h"

using namespace mote;

constexpr float sigma = 1.5f;         // extinction and scattering of the fog [1/m]
constexpr float connections = 12.0f;  // of a receiver, sampled by importance
constexpr std::size_t candidates = 128;

/// Irradiance of a wall by the lamp itself [W/m^2].
double from_lamp(const core::ScatteringVertex& vertex) {
    const core::Vec3 to_lamp = core::Vec3(0.4f, 0.5f, 0.6f) - vertex.position;
    const double distance = double(glm::length(to_lamp));
    const double cosine = double(glm::dot(vertex.hit.geometric_normal, to_lamp)) / distance;
    return double(room::intensity) * cosine / (distance * distance) * std::exp(-double(sigma) * distance);
}

int main() {
    const room::Room room{
        .medium = std::make_shared<media::HomogeneousMedium>(
            core::Rgb(sigma), core::Rgb(sigma), core::Rgb(0.0f), std::make_shared<media::IsotropicPhase>())};
    const lights::ScatteringMedia fog(room.scene.media());
    // A segment of a light path is a ray light; VPLs are left on surfaces alone.
    const lights::RayLightSet set =
        lights::trace_ray_lights(room.scene, fog, {.paths = 1024}, 1, 0, core::SamplerKind::sobol);

    room::Receivers receivers{room};
    lights::LineGather gather(receivers.context(), set, candidates);
    lights::LineCandidates found;
    core::Lanes around;  // extinction around the receivers, by lane
    std::fill(around.begin(), around.end(), sigma);
    const auto [irradiance, error] =
        receivers.irradiance([&](const auto& vertices, lights::ReceiverTile& tile, core::Rng& rng) {
            found.clear();
            gather.sample_candidates(rng, lights::ReceiverLanes::width);
            gather.evaluate(lights::PointReceivers(tile, around, core::infinity), found);
            core::Lanes steps = found.total();  // light that a connection carries
            for (std::size_t i = 0; i < vertices.size(); ++i) steps[i] /= connections;
            lights::TileLight light = gather.to_points(found, steps, core::infinity, tile);
            for (std::size_t i = 0; i < vertices.size(); ++i)
                light[i] += core::Rgb(float(from_lamp(vertices[i])) * room::reflectance / core::pi);
            return light;
        });
    std::printf(
        "%zu ray lights, %zu VPLs, %llu shadow rays of %llu pairs: walls receive %.3f +- %.3f W/m^2, %.3f by "
        "energy\n",
        set.rays.size(), set.surface.lights.size(),
        static_cast<unsigned long long>(gather.counters().connected),
        static_cast<unsigned long long>(gather.counters().pairs), irradiance, error, room::all_light);
    // One set of light paths, besides the noise of the receivers.
    return std::fabs(irradiance - room::all_light) < 4.0 * error + 0.02 * room::all_light ? 0 : 1;
}
