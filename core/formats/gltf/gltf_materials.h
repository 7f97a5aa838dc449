// Materials of glTF 2.0 as BSDFs, area lights and media of ours.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>

#include "core/formats/gltf/gltf_textures.h"

namespace mote::core {

/// Properties of a material that concern the shapes that have it.
struct GltfMaterial {
    std::size_t uv_set = 0;
    bool emissive = false, double_sided = false, normal_map = false;
    bool base_texture = false;  ///< base colours come from a picture
    Rgb base_factor{1.0f};
};

class GltfMaterials {
  public:
    /// Radiance is the emissive colour [cd/m^2] times `emission_scale`. BSDFs are written into `scene`.
    GltfMaterials(GltfFile& file, GltfTextures& textures, ConversionReport& report, pugi::xml_node scene,
                  double emission_scale)
        : file_(file), textures_(textures), report_(report), scene_(scene), emission_scale_(emission_scale) {}

    /// materials[number], or the default material. Lives as long as this.
    const GltfMaterial& get(std::optional<std::size_t> number);
    /// The id of its BSDF. `colours`: the mesh has colours of its own (multiplied by base_factor already);
    /// `turned`: the mesh shows pictures turned over (gltf_mesh.h).
    std::string bsdf(std::optional<std::size_t> number, bool colours, bool turned);
    /// The area light and the medium inside, where the material has them.
    void add_light_and_medium(pugi::xml_node shape, std::optional<std::size_t> number);

    /// Light passes some surface straight on: through a hole, or a pane.
    bool passes_straight() const { return passes_straight_; }

  private:
    GltfValue value(std::optional<std::size_t> number);
    GltfMaterial read(const GltfValue& material);
    void check(const GltfValue& material);
    Rgb emission(const GltfValue& material);
    bool has_holes(const GltfValue& material);
    pugi::xml_node add_holes(pugi::xml_node parent, const GltfValue& material, const std::string& id);
    void add_surface(pugi::xml_node parent, const GltfValue& material, const std::string& id, bool colours);
    void add_scalar(pugi::xml_node parent, const std::string& name, const GltfValue& info, int channel,
                    double factor);
    void add_base_colour(pugi::xml_node parent, const std::string& name, const GltfValue& material,
                         bool colours);

    GltfFile& file_;
    GltfTextures& textures_;
    ConversionReport& report_;
    pugi::xml_node scene_;
    double emission_scale_;
    bool passes_straight_ = false;
    std::map<std::size_t, std::unique_ptr<GltfMaterial>> read_;  ///< SIZE_MAX: the default material
    std::map<std::string, std::string> ids_;
};

}  // namespace mote::core
