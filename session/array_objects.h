// Shapes and volumes from arrays in memory, as types of the scene language: `arraymesh` and `arraygrid` name
// an array of a store where `ply` and `gridvolume` name a file. So a host's arrays go through the same
// elements, checks and messages as scene files do.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "core/geometry/triangle_mesh.h"
#include "media/vol_file.h"

namespace mote::core {
class Registry;
}

namespace mote::session {

/// Arrays of a host, by names of its choice.
class ArrayStore {
  public:
    /// Positions [m] in the space of the shape. Throws InputError for a name that is taken, sizes that do not
    /// fit, indices out of range, and values that are not finite.
    void add_mesh(const std::string& name, core::MeshData mesh);
    /// `values`: x fastest, one or three channels interleaved; none negative. `bounds` hold where the volume
    /// says use_grid_bbox. Throws InputError likewise.
    void add_grid(const std::string& name, media::VolFile grid);

    /// Throw InputError with the nearest name there is.
    const core::MeshData& mesh(const std::string& name) const;
    const media::VolFile& grid(const std::string& name) const;
    /// Over all that is in it: changes when any value does. 16 hexadecimal digits.
    std::string checksum() const;

  private:
    std::map<std::string, core::MeshData> meshes_;
    std::map<std::string, media::VolFile> grids_;
};

/// Adds `arraymesh` and `arraygrid`, which read from the store.
void register_arrays(core::Registry& registry, std::shared_ptr<const ArrayStore> store);

}  // namespace mote::session
