// Meshes that were read before, so that scenes which are loaded one after the other, as the frames of a
// sequence are, read and build anew only what has changed.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/geometry/triangle_mesh.h"

namespace mote::core {

/// Not for several threads.
class MeshCache {
  public:
    /// A shape of the mesh of that name, which `make` makes where none is kept; then what no shape holds any
    /// more is forgotten. Passes on what `make` throws.
    std::shared_ptr<TriangleMesh> get(const std::string& name,
                                      const std::function<std::shared_ptr<TriangleMesh>()>& make);
    std::size_t size() const { return meshes_.size(); }

  private:
    std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes_;  ///< nothing is attached to them
};

}  // namespace mote::core
