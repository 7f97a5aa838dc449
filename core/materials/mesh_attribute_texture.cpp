// Texture "mesh_attribute": values that a mesh carries for its vertices or faces.
#include "core/materials/register_materials.h"
#include "core/materials/texture_rows.h"

namespace mote::core {
namespace {

class MeshAttributeTexture final : public Texture {
  public:
    MeshAttributeTexture(std::string name, float scale) : name_(std::move(name)), scale_(scale) {}

    Rgb eval(const TextureCoordinates& uv) const override {
        if (!uv.attributes) return Rgb(0.0f);
        return scale_ * uv.attributes->attribute(name_, uv.primitive, uv.barycentric);
    }
    // Without a shape nothing is known; the loader checks the values of each shape that uses the texture.
    Rgb mean() const override { return Rgb(0.5f); }
    Rgb mean_over(const SurfaceAttributes& surface) const override {
        return scale_ * surface.attribute_mean(name_);
    }
    float maximum() const override { return 1.0f; }
    float minimum() const override { return 0.0f; }

  private:
    std::string name_;
    float scale_;
};

struct MeshAttributeSettings {
    std::string name;
    float scale = 1.0f;
};

std::shared_ptr<Texture> create(const MeshAttributeSettings& s, const Properties& p) {
    if (!s.name.starts_with("vertex_") && !s.name.starts_with("face_"))
        throw InputError("the name of an attribute begins with 'vertex_' or 'face_', not as '" +
                             printable(s.name) + "' does",
                         p.where_of("name"));
    return std::make_shared<MeshAttributeTexture>(s.name, s.scale);
}

}  // namespace

void register_mesh_attribute_texture(Registry& registry) {
    add_type<MeshAttributeSettings>(
        registry, Category::texture, "mesh_attribute",
        "Values that a mesh carries: of its vertices, interpolated, or of its faces. PLY files hold them as "
        "properties r, g, b (or red, green, blue) in 'vertex_color' and 'face_color', foo_r, foo_g, foo_b in "
        "'vertex_foo_color', and foo_x, foo_y, foo_z or foo_x alone in 'vertex_foo'; serialized files as "
        "'vertex_color'. Colours that are integers are divided by the largest one (Mitsuba takes 255 for "
        "255).",
        {row("name", &MeshAttributeSettings::name, "vertex_color, face_color, ...: see above.").required(),
         row("scale", &MeshAttributeSettings::scale, between(0, 1e6), "Factor on the values.")},
        R"(<texture type="mesh_attribute" name="reflectance">
    <string name="name" value="vertex_color"/>
</texture>)",
        create);
}

}  // namespace mote::core
