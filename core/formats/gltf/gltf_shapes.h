// Meshes of a glTF scene as shapes, with a PLY file for each primitive.
#pragma once

#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "core/formats/gltf/gltf_materials.h"
#include "core/formats/gltf/gltf_nodes.h"
#include "core/geometry/triangle_mesh.h"

namespace mote::core {

class GltfShapes {
  public:
    GltfShapes(GltfFile& file, GltfMaterials& materials, OutputFolder& folder, const std::string& prefix,
               ConversionReport& report)
        : file_(file), materials_(materials), folder_(folder), prefix_(prefix), report_(report) {}

    /// Writes all meshes of these nodes. A mesh of several nodes is a shapegroup with instances, unless it
    /// emits light.
    void add(pugi::xml_node scene, const std::vector<GltfNode>& nodes);
    /// Bounds of all shapes added.
    const Bounds3& bounds() const { return bounds_; }
    bool emits() const { return emits_; }
    bool has_media() const { return has_media_; }

  private:
    /// A primitive, or the part of it that needs a material of its own.
    struct Part {
        std::string file, bsdf;
        std::optional<std::size_t> material;
        bool flat = false;       ///< no normals of its own
        bool two_lamps = false;  ///< emits on both sides, and can be seen from both
        MeshData mesh;           ///< kept for two_lamps alone
        Bounds3 bounds;
    };
    using Parts = std::vector<Part>;

    const Parts& parts_of(std::size_t mesh, bool mirrored);
    void read_primitive(Parts& parts, const GltfValue& primitive, const std::string& name, bool mirrored);
    void add_part(Parts& parts, MeshData mesh, const std::string& name, std::optional<std::size_t> material,
                  bool turned);
    void add_shape(pugi::xml_node parent, const Part& part, const Transform* to_world);
    void add_back_lamp(pugi::xml_node parent, const Part& part, const Transform& to_world);
    void place(pugi::xml_node scene, std::size_t mesh, const GltfNode& node, bool in_group);
    bool can_be_instanced(std::size_t mesh);
    void extend(const Part& part, const Transform& to_world);

    GltfFile& file_;
    GltfMaterials& materials_;
    OutputFolder& folder_;
    std::string prefix_;
    ConversionReport& report_;
    Bounds3 bounds_;
    bool emits_ = false, has_media_ = false;
    std::map<std::pair<std::size_t, bool>, Parts> parts_;
    std::map<std::pair<std::size_t, bool>, std::string> groups_;
    int copies_ = 0;
};

}  // namespace mote::core
