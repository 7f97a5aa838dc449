// Shapes of a pbrt scene as elements, with PLY files for meshes, and groups for ObjectBegin and its
// instances.
#pragma once

#include "core/formats/pbrt/pbrt_materials.h"
#include "core/geometry/triangle_mesh.h"

namespace mote::core {

/// State of the reader that a shape depends on.
struct PbrtShapeState {
    Transform to_world;
    bool reverse_orientation = false;
    std::string material;         ///< its id
    std::string inside, outside;  ///< media, "" for none
    const PbrtObject* light = nullptr;
};

class PbrtShapes {
  public:
    PbrtShapes(pugi::xml_node scene, PbrtTextures& textures, PbrtMaterials& materials, PbrtFiles& files)
        : scene_(scene), textures_(textures), materials_(materials), files_(files) {}

    void add(const PbrtObject& shape, const PbrtShapeState& state);
    void begin_object(const std::string& name, const SourceLocation& where);
    void end_object();
    bool in_object() const { return !object_.empty(); }
    void add_instance(const std::string& name, const Transform& to_world, const SourceLocation& where);
    /// Writes what was collected: curves and instances.
    void finish();
    /// Factor on the radiance of area lights.
    void set_exposure(double exposure) { exposure_ = exposure; }

  private:
    struct Group {
        pugi::xml_node node;
        std::string id;
    };
    struct Instance {
        std::string name;
        Transform to_world;
        SourceLocation where;
    };

    pugi::xml_node parent() { return object_.empty() ? scene_ : groups_[object_].node; }
    void add_sphere(const PbrtObject& shape, const PbrtShapeState& state);
    void add_disk(const PbrtObject& shape, const PbrtShapeState& state);
    void add_cylinder(const PbrtObject& shape, const PbrtShapeState& state);
    void add_ply(const PbrtObject& shape, const PbrtShapeState& state);
    void add_mesh(MeshData mesh, const PbrtObject& shape, const PbrtShapeState& state);
    void add_curve(const PbrtObject& shape, const PbrtShapeState& state);
    pugi::xml_node add_file(const std::string& in_xml, bool faceted, const Transform* to_world);
    void add_appearance(pugi::xml_node element, const PbrtObject& shape, const PbrtShapeState& state,
                        double area);
    void add_other_side(MeshData mesh, const PbrtShapeState& state, const std::string& material, double area);
    std::string material_of(const PbrtObject& shape, const PbrtShapeState& state);
    bool shines(const PbrtShapeState& state) const;
    void flush_curves();

    pugi::xml_node scene_;
    PbrtTextures& textures_;
    PbrtMaterials& materials_;
    PbrtFiles& files_;
    std::string object_;  ///< the one being defined
    std::map<std::string, Group> groups_;
    std::vector<Instance> instances_;
    std::map<std::string, std::string> curves_;  ///< text by material
    double exposure_ = 1.0;
};

}  // namespace mote::core
