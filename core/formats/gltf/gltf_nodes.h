// The tree of nodes of a glTF scene, laid flat: what stands where in the world.
#pragma once

#include <vector>

#include "core/formats/gltf/gltf_file.h"
#include "core/formats/conversion/conversion_report.h"
#include "core/math/transform.h"

namespace mote::core {

struct GltfNode {
    GltfValue value;
    Transform to_world;
};

/// Nodes of the file's scene (the first where it names none), parents before children, in the order of the
/// file. Throws InputError for a node that is reached twice. Poses that are not built in are reported.
std::vector<GltfNode> gltf_nodes(const GltfFile& file, ConversionReport& report);

}  // namespace mote::core
