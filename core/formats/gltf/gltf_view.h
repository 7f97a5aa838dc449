// Cameras and lights of a glTF scene as sensors and emitters of ours.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "core/formats/gltf/gltf_nodes.h"
#include "core/math/bounds.h"

namespace mote::core {

/// Writes the camera called `name` (its own name or its node's), or the first one; where there is none, one
/// that shows `bounds`. Throws InputError with the nearest name.
void add_gltf_camera(pugi::xml_node scene, const GltfFile& file, const std::vector<GltfNode>& nodes,
                     const std::string& name, const Bounds3& bounds, ConversionReport& report);

/// Writes the lights of KHR_lights_punctual. Returns how many.
std::size_t add_gltf_lights(pugi::xml_node scene, const GltfFile& file, const std::vector<GltfNode>& nodes,
                            ConversionReport& report);

}  // namespace mote::core
