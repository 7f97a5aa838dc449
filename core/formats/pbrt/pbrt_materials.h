// Materials of pbrt scenes as BSDFs.
#pragma once

#include <set>

#include "core/formats/pbrt/pbrt_textures.h"

namespace mote::core {

class PbrtMaterials {
  public:
    PbrtMaterials(PbrtTextures& textures, PbrtFiles& files) : textures_(textures), files_(files) {}

    /// The directive Material: returns its id.
    std::string add(PbrtObject object);
    /// The directive MakeNamedMaterial.
    void add_named(const std::string& name, PbrtObject object);
    /// The id of a named material, which may be defined later.
    std::string named(const std::string& name, const SourceLocation& where);
    /// The id of the same material with holes.
    std::string with_holes(const std::string& id, const PbrtTexturePtr& opacity);
    /// Writes all materials that use() named.
    void write(pugi::xml_node scene);
    void use(const std::string& id) { used_.insert(id); }

  private:
    struct Roughness {
        PbrtTexturePtr u, v;  ///< alpha of GGX
        bool smooth() const;
    };
    struct Holes {
        std::string id;
        PbrtTexturePtr opacity;
    };
    using Writer = void (PbrtMaterials::*)(pugi::xml_node parent, const std::string& id, const PbrtObject&);
    static const std::map<std::string, Writer>& writers();

    void write_one(pugi::xml_node scene, const std::string& id, const PbrtObject& object);
    void write_surface(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void diffuse(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void coated_diffuse(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void conductor(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void coated_conductor(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void dielectric(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void thin_dielectric(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void diffuse_transmission(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void mix(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void interface(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void measured(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void subsurface(pugi::xml_node parent, const std::string& id, const PbrtObject& object);
    void hair(pugi::xml_node parent, const std::string& id, const PbrtObject& object);

    void add_metal(pugi::xml_node parent, const std::string& id, const PbrtObject& object,
                   const std::string& prefix);
    void add_coating(pugi::xml_node parent, const std::string& id, const PbrtObject& object,
                     const PbrtTexturePtr& base, double eta);
    Roughness roughness(const PbrtObject& object, const std::string& prefix = "");
    void add_roughness(pugi::xml_node bsdf, const Roughness& alpha);
    pugi::xml_node add_bent_normals(pugi::xml_node parent, std::string& id, const PbrtObject& object);
    void replaced(const PbrtObject& object, const std::string& by);

    PbrtTextures& textures_;
    PbrtFiles& files_;
    std::map<std::string, PbrtObject> objects_;     ///< by id
    std::map<std::string, SourceLocation> wanted_;  ///< ids of named materials, and where they were requested
    std::map<std::string, Holes> holes_;
    std::map<std::string, std::string> names_;  ///< ids of named materials
    std::set<std::string> used_;
};

}  // namespace mote::core
