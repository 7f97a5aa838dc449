// Visibility by volumetric shadow maps, prepared for a scene: eye paths store their receivers, and all VPLs
// then add their light to them, in batches whose maps use the same memory again.
//
// Every pixel's sum is taken in the order of the VPLs by one task at a time, so neither threads nor the size
// of the batches change a bit of it.
#pragma once

#include "lights/shadow_maps/shadow_map_builder.h"
#include "lights/visibility/visibility.h"

namespace mote::lights {

struct MappedVisibilitySettings {
    int size = 64;            ///< texels along an edge of a VPL's map
    int maps = 4;             ///< kept at once
    LightMapSettings lights;  ///< of the lights' own maps; what is not the size is that of all
};

/// Throws InputError with its place when a map of `edge` * `edge` texels would be larger than the limit.
void check_map(const core::LitScene& scene, const LightMapSettings& settings, int edge);

/// Builds the maps of the lights. Throws InputError when a map would be larger than its limit, OutOfMemory
/// when all of them are larger than `memory`.
std::unique_ptr<PreparedVisibility> prepare_mapped_visibility(const core::LitScene& scene,
                                                              const MappedVisibilitySettings& settings,
                                                              const core::MemoryBudget& memory);

}  // namespace mote::lights
