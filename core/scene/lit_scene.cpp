#include "core/scene/lit_scene.h"

namespace mote::core {

/// Where a light with a position stands. Lights at infinity and area lights (part of the shapes) have none.
std::optional<Vec3> LitScene::light_position(const Emitter& emitter) {
    const EmitterTraits traits = emitter.traits();
    if (!traits.delta_position || traits.infinite) return std::nullopt;
    // A textured light is black in some directions; one of these samples will do.
    for (const float u : {0.5f, 0.1f, 0.9f, 0.3f, 0.7f})
        if (const auto sample = emitter.sample_emission({u, u}, {u, 1.0f - u})) return sample->origin;
    return std::nullopt;
}

}  // namespace mote::core
