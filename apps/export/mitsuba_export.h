// A scene of ours as a folder that Mitsuba 3 renders alike.
//
// The work is done on the scene's elements, so that the file stays readable: what both programs understand is
// kept as it is written; what they understand differently is made explicit; what is ours alone is replaced by
// the nearest of theirs or left out, and each of those changes is noted.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/formats/xml/scene_loader.h"
#include "core/geometry/triangle_mesh.h"
#include "core/objects/registry.h"
#include "media/vol_file.h"

namespace mote::apps {

struct MitsubaExport {
    core::Element scene;
    std::vector<std::string> notes;                ///< "file:line: what was dropped or changed"
    std::map<std::string, std::string> copies;     ///< name in the folder -> file to copy
    std::map<std::string, media::VolFile> grids;   ///< name in the folder -> grid to write
    std::map<std::string, core::MeshData> meshes;  ///< name in the folder -> mesh to write as PLY
    std::vector<std::string> inputs;               ///< files that the scene was read from
};

/// `file` is its name in messages. Throws InputError for a scene that mote would not render, and for a grid
/// whose dense twin would be larger than `max_grid_bytes`.
MitsubaExport export_to_mitsuba(core::SceneDocument document, const core::Registry& registry,
                                const std::string& file, std::uint64_t max_grid_bytes);

/// Writes scene.xml, dropped.txt and all other files into `folder`, which is made. Throws InputError for what
/// cannot be written, and before it writes anything where a file of the scene would be replaced.
void write_export(const MitsubaExport& result, const std::string& folder);

}  // namespace mote::apps
