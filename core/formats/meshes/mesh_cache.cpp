#include "core/formats/meshes/mesh_cache.h"

namespace mote::core {

std::shared_ptr<TriangleMesh> MeshCache::get(const std::string& name,
                                             const std::function<std::shared_ptr<TriangleMesh>()>& make) {
    auto at = meshes_.find(name);
    if (at == meshes_.end()) {
        std::erase_if(meshes_, [](const auto& entry) { return entry.second->holders() == 1; });
        at = meshes_.emplace(name, make()).first;
    }
    return std::make_shared<TriangleMesh>(*at->second);
}

}  // namespace mote::core
