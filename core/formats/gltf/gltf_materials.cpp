// Metallic-roughness materials (glTF 2.0, Sec. 3.9 and Appendix B) as `principled`, and what extensions add.
#include "core/formats/gltf/gltf_materials.h"

#include <cmath>
#include <limits>

#include "core/formats/gltf/photometry.h"
#include "core/formats/conversion/scene_xml.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

Rgb colour(const GltfValue& value, const Rgb& default_value) {
    const auto n = value.numbers({default_value.x, default_value.y, default_value.z});
    return {float(n[0]), float(n[1]), float(n[2])};
}

GltfValue extension(const GltfValue& value, const std::string& name) {
    return value["extensions"]["KHR_materials_" + name];
}

/// Extensions that have no counterpart here, and the number that switches each off.
struct Unknown {
    const char *name, *key;
    std::vector<double> off;
};
const std::vector<Unknown>& unknown_extensions() {
    static const std::vector<Unknown> list = {
        {"clearcoat", "clearcoatFactor", {0}},     {"sheen", "sheenColorFactor", {0, 0, 0}},
        {"iridescence", "iridescenceFactor", {0}}, {"anisotropy", "anisotropyStrength", {0}},
        {"dispersion", "dispersion", {0}},         {"diffuse_transmission", "diffuseTransmissionFactor", {0}},
        {"specular", "specularFactor", {1}},       {"specular", "specularColorFactor", {1, 1, 1}}};
    return list;
}

GltfValue pbr(const GltfValue& material) { return material["pbrMetallicRoughness"]; }

double alpha_factor(const GltfValue& material) {
    return pbr(material)["baseColorFactor"].numbers({1.0, 1.0, 1.0, 1.0})[3];
}
Rgb base_factor(const GltfValue& material) {
    const auto n = pbr(material)["baseColorFactor"].numbers({1.0, 1.0, 1.0, 1.0});
    return glm::clamp(Rgb(float(n[0]), float(n[1]), float(n[2])), 0.0f, 1.0f);
}

double index_of_refraction(const GltfValue& material, ConversionReport& report) {
    const double ior = extension(material, "ior")["ior"].number_in(1.5, 0.0, 100.0);
    if (ior >= 1.0) return ior;
    report.fault(material.title() + " has an index of refraction below 1", "1.5 stands in its place");
    return 1.5;
}

/// Glass encloses a volume; without, it is a thin sheet that light passes straight on.
bool encloses_volume(const GltfValue& material) {
    return extension(material, "volume")["thicknessFactor"].number(0.0) > 0.0;
}

double transmission_factor(const GltfValue& material) {
    return extension(material, "transmission")["transmissionFactor"].number_in(0.0, 0.0, 1.0);
}

/// Ids of XML: letters and digits of the name, and the number, which is the material's alone.
std::string id_of(const GltfValue& material, std::optional<std::size_t> number) {
    std::string id;
    for (const char c : number ? material["name"].text("material") : std::string("default"))
        id += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return id.substr(0, 60) + (number ? "_" + std::to_string(*number) : "_material");
}

}  // namespace

GltfValue GltfMaterials::value(std::optional<std::size_t> number) {
    return number ? file_.root()["materials"].at(*number) : file_.root()["(no material)"];
}

const GltfMaterial& GltfMaterials::get(std::optional<std::size_t> number) {
    auto& material = read_[number.value_or(std::numeric_limits<std::size_t>::max())];
    if (!material) material = std::make_unique<GltfMaterial>(read(value(number)));
    return *material;
}

/// Anything without a counterpart here is reported once, when the material is used first.
void GltfMaterials::check(const GltfValue& material) {
    const GltfValue extensions = material["extensions"];
    for (const Unknown& u : unknown_extensions()) {
        const std::string name = std::string("KHR_materials_") + u.name;
        const GltfValue given = extensions[name][u.key];
        if (u.off.size() == 1 ? given.number(u.off[0]) != u.off[0] : given.numbers(u.off) != u.off)
            report_.fault(material.title() + " uses " + name + ", which has no counterpart here", "left out");
    }
    if (extensions["KHR_materials_pbrSpecularGlossiness"].present() && !pbr(material).present())
        report_.fault(material.title() + " is given by KHR_materials_pbrSpecularGlossiness alone",
                      "a white metal stands in its place");
    if (extensions["KHR_materials_unlit"].present())
        report_.note(material.title() +
                     " is unlit (KHR_materials_unlit): it is diffuse here, and needs light");
}

GltfMaterial GltfMaterials::read(const GltfValue& material) {
    check(material);
    GltfMaterial m;
    std::optional<std::size_t> set;
    for (const GltfValue& info :
         {pbr(material)["baseColorTexture"], pbr(material)["metallicRoughnessTexture"],
          material["normalTexture"], material["emissiveTexture"],
          extension(material, "transmission")["transmissionTexture"]}) {
        if (!info.present() || !textures_.image_of(info)) continue;
        const std::size_t other = GltfTextures::uv_set(info);
        if (set && *set != other)
            report_.fault(material.title() + " looks its textures up with more than one set of coordinates",
                          "all use TEXCOORD_" + std::to_string(*set));
        if (!set) set = other;
    }
    m.uv_set = set.value_or(0);
    m.base_texture = textures_.image_of(pbr(material)["baseColorTexture"]).has_value();
    m.base_factor = base_factor(material);
    m.normal_map = textures_.image_of(material["normalTexture"]).has_value();
    m.double_sided = material["doubleSided"].flag(false);
    m.emissive = !is_black(emission(material));
    if (m.emissive && has_holes(material)) {
        report_.fault(
            material.title() + " emits light and has holes (alpha): here a surface has one or the other",
            "it emits nothing");
        m.emissive = false;
    }
    return m;
}

/// Factor of an emissive texture; W/(m^2 sr).
Rgb GltfMaterials::emission(const GltfValue& material) {
    const double strength = extension(material, "emissive_strength")["emissiveStrength"].number(1.0);
    const Rgb factor = colour(material["emissiveFactor"], Rgb(0.0f));
    if (min_component(factor) < 0.0f || strength < 0.0) material["emissiveFactor"].refuse("is negative");
    const Rgb light = factor * float(strength * emission_scale_ / lumens_per_watt);
    const GltfValue info = material["emissiveTexture"];
    if (is_black(light) || !info.present()) return light;
    const auto image = textures_.image_of(info);
    return image && !textures_.light(*image, light) ? Rgb(0.0f) : light;
}

bool GltfMaterials::has_holes(const GltfValue& material) {
    const std::string mode = material["alphaMode"].text("OPAQUE");
    if (mode == "OPAQUE") return false;
    const bool cut = mode == "MASK";
    if (!cut && mode != "BLEND")
        material["alphaMode"].refuse("is '" + printable(mode, 20) + "': known are OPAQUE, MASK, BLEND");
    const double factor = alpha_factor(material), cutoff = material["alphaCutoff"].number(0.5);
    const auto image = textures_.image_of(pbr(material)["baseColorTexture"]);
    if (!image) return cut ? factor < cutoff : factor < 1.0;
    return textures_.opacity(*image, factor, cut ? std::optional(cutoff) : std::nullopt).has_value();
}

/// <bsdf type="mask">, where the surface has holes.
pugi::xml_node GltfMaterials::add_holes(pugi::xml_node parent, const GltfValue& material,
                                        const std::string& id) {
    const bool cut = material["alphaMode"].text() == "MASK";
    const double factor = alpha_factor(material), cutoff = material["alphaCutoff"].number(0.5);
    const GltfValue info = pbr(material)["baseColorTexture"];
    pugi::xml_node mask = add_object(parent, "bsdf", "mask", "", id);
    passes_straight_ = true;
    if (const auto image = textures_.image_of(info))
        textures_.add(mask, "opacity", info,
                      *textures_.opacity(*image, factor, cut ? std::optional(cutoff) : std::nullopt));
    else
        add_float(mask, "opacity", cut ? 0.0 : std::fmax(factor, 0.0));
    return mask;
}

void GltfMaterials::add_base_colour(pugi::xml_node parent, const std::string& name, const GltfValue& material,
                                    bool colours) {
    const GltfValue info = pbr(material)["baseColorTexture"];
    if (const auto image = textures_.image_of(info)) {
        textures_.add(parent, name, info, textures_.colours(*image, base_factor(material)));
    } else if (colours) {
        add_value(add_object(parent, "texture", "mesh_attribute", name), "string", "name", "vertex_color");
    } else {
        add_rgb(parent, name, base_factor(material));
    }
}

void GltfMaterials::add_scalar(pugi::xml_node parent, const std::string& name, const GltfValue& info,
                               int channel, double factor) {
    const auto image = info.present() ? textures_.image_of(info) : std::nullopt;
    if (image && factor > 0.0)
        textures_.add(parent, name, info, textures_.channel(*image, channel, factor));
    else
        add_float(parent, name, factor);
}

/// The surface without holes: red, green and blue of the metallic-roughness texture are nothing, roughness
/// and metal.
void GltfMaterials::add_surface(pugi::xml_node parent, const GltfValue& material, const std::string& id,
                                bool colours) {
    if (extension(material, "unlit").present())
        return add_base_colour(add_object(parent, "bsdf", "diffuse", "", id), "reflectance", material,
                               colours);
    const GltfValue both = pbr(material)["metallicRoughnessTexture"];
    const double roughness = pbr(material)["roughnessFactor"].number_in(1.0, 0.0, 1.0);
    const double metallic = pbr(material)["metallicFactor"].number_in(1.0, 0.0, 1.0);
    const GltfValue shares = extension(material, "transmission")["transmissionTexture"];
    const double transmission = transmission_factor(material), eta = index_of_refraction(material, report_);
    const bool thin = transmission > 0.0 && !encloses_volume(material);
    if (thin && transmission == 1.0 && roughness == 0.0 && metallic == 0.0 && !shares.present()) {
        pugi::xml_node pane = add_object(parent, "bsdf", "thindielectric", "", id);
        passes_straight_ = true;
        add_float(pane, "int_ior", eta), add_float(pane, "ext_ior", 1.0);
        return add_base_colour(pane, "specular_transmittance", material, colours);
    }
    pugi::xml_node bsdf = add_object(parent, "bsdf", thin ? "principledthin" : "principled", "", id);
    add_base_colour(bsdf, "base_color", material, colours);
    add_scalar(bsdf, "roughness", both, 1, roughness);
    add_float(bsdf, "eta", eta);
    if (transmission > 0.0) add_scalar(bsdf, "spec_trans", shares, 0, transmission);
    if (!thin)
        add_scalar(bsdf, "metallic", both, 2, metallic);
    else if (metallic > 0.0)
        report_.fault(material.title() + " is a thin sheet that transmits light, and metal",
                      "it is no metal");
}

std::string GltfMaterials::bsdf(std::optional<std::size_t> number, bool colours, bool turned) {
    const GltfValue material = value(number);
    const std::string id = id_of(material, number) + (colours ? "_colours" : "") + (turned ? "_turned" : "");
    if (!ids_.emplace(id, id).second) return id;
    const GltfValue normals = material["normalTexture"];
    const auto normal_image = textures_.image_of(normals);
    pugi::xml_node parent = scene_;
    std::string outermost = id;  // the id belongs to the outermost one
    const auto nest = [&](pugi::xml_node node) { parent = node, outermost.clear(); };
    if (has_holes(material)) nest(add_holes(parent, material, outermost));
    if (get(number).double_sided && transmission_factor(material) == 0.0)
        nest(add_object(parent, "bsdf", "twosided", "", outermost));
    if (normal_image) {
        nest(add_object(parent, "bsdf", "normalmap", "", outermost));
        textures_.add(parent, "normalmap", normals,
                      textures_.normals(*normal_image, normals["scale"].number(1.0), turned));
    }
    add_surface(parent, material, outermost, colours);
    return id;
}

void GltfMaterials::add_light_and_medium(pugi::xml_node shape, std::optional<std::size_t> number) {
    const GltfValue material = value(number);
    if (get(number).emissive) {
        pugi::xml_node light = add_object(shape, "emitter", "area");
        const Rgb radiance = emission(material);
        const GltfValue info = material["emissiveTexture"];
        const auto image = info.present() ? textures_.image_of(info) : std::nullopt;
        if (image)
            textures_.add(light, "radiance", info, *textures_.light(*image, radiance));
        else
            add_rgb(light, "radiance", radiance);
    }
    const GltfValue volume = extension(material, "volume");
    const double distance = volume["attenuationDistance"].number(0.0);
    const Rgb left = glm::clamp(colour(volume["attenuationColor"], Rgb(1.0f)), 1e-6f, 1.0f);
    if (transmission_factor(material) == 0.0 || !encloses_volume(material)) return;
    if (!(distance > 0.0) || left == Rgb(1.0f)) return;
    // Remaining white light after that distance (KHR_materials_volume).
    const Rgb sigma_t = -glm::log(left) / float(distance);
    pugi::xml_node medium = add_object(shape, "medium", "homogeneous", "interior");
    add_rgb(medium, "sigma_t", sigma_t / max_component(sigma_t));  // Mitsuba takes colours up to 1
    add_float(medium, "scale", max_component(sigma_t));
    add_float(medium, "albedo", 0.0);
}

}  // namespace mote::core
