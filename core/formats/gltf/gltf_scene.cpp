// Puts the parts of a scene together.
#include "core/formats/gltf/gltf_scene.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>

#include "core/formats/gltf/gltf_shapes.h"
#include "core/formats/gltf/gltf_view.h"
#include "core/formats/conversion/scene_xml.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

/// Read here, harmless, or reported where they are met.
const std::set<std::string>& known_extensions() {
    static const std::set<std::string> known = {
        "KHR_lights_punctual",        "KHR_materials_emissive_strength",
        "KHR_materials_ior",          "KHR_materials_transmission",
        "KHR_materials_unlit",        "KHR_materials_volume",
        "KHR_mesh_quantization",      "KHR_texture_transform",
        "KHR_materials_clearcoat",    "KHR_materials_sheen",
        "KHR_materials_iridescence",  "KHR_materials_anisotropy",
        "KHR_materials_dispersion",   "KHR_materials_diffuse_transmission",
        "KHR_materials_specular",     "KHR_materials_pbrSpecularGlossiness",
        "KHR_draco_mesh_compression", "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing",    "KHR_texture_basisu",
        "EXT_texture_webp",           "KHR_xmp_json_ld",
        "KHR_animation_pointer"};
    return known;
}

void check_extensions(const GltfValue& root, ConversionReport& report) {
    const auto names = [&](const char* list) {
        std::vector<std::string> found;
        for (std::size_t i = 0; i < root[list].size(); ++i) {
            const std::string name = root[list].at(i).text();
            if (!known_extensions().count(name)) found.push_back(printable(name, 60));
        }
        return found;
    };
    const std::vector<std::string> required = names("extensionsRequired");
    for (const std::string& name : required)
        report.fault("the scene requires the extension " + name + ", which is not known here", "ignored");
    for (const std::string& name : names("extensionsUsed"))
        if (std::find(required.begin(), required.end(), name) == required.end())
            report.note("the extension " + name + " is not known here, and is ignored");
    if (root["animations"].size() > 0)
        report.note("animations are not played: everything stands as it is stored");
}

void append_all(pugi::xml_node parent, const pugi::xml_document& from) {
    for (const pugi::xml_node child : from) parent.append_copy(child);
}

}  // namespace

bool is_gltf(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension == ".gltf" || extension == ".glb";
}

ConvertedScene convert_gltf(const std::string& path, const std::filesystem::path& folder,
                       const ConversionOptions& options) {
    GltfFile file(path);
    ConvertedScene scene{{}, ConversionReport(path), {}};
    check_extensions(file.root(), scene.report);
    pugi::xml_document view, materials, shapes, lights;
    OutputFolder output(folder);
    GltfTextures textures(file, output, options.prefix, options.copy_files, scene.report);
    GltfMaterials looks(file, textures, scene.report, materials, options.emission);
    GltfShapes meshes(file, looks, output, options.prefix, scene.report);

    const std::vector<GltfNode> nodes = gltf_nodes(file, scene.report);
    meshes.add(shapes, nodes);
    if (meshes.bounds().empty()) throw InputError("the scene shows no triangles", {path, 0});
    add_gltf_camera(view, file, nodes, options.camera, meshes.bounds(), scene.report);
    if (add_gltf_lights(lights, file, nodes, scene.report) == 0 && !meshes.emits()) {
        add_rgb(add_object(lights, "emitter", "constant"), "radiance", Rgb(1.0f));
        scene.report.note("the scene has no light: white light of radiance 1 comes from everywhere");
    }

    pugi::xml_document document;
    pugi::xml_node root = document.append_child("scene");
    root.append_attribute("version") = "3.0.0";
    // Mitsuba's path lets no shadow ray through holes and panes; its volpath does, as both of ours.
    const bool volpath = meshes.has_media() || looks.passes_straight();
    add_object(root, "integrator", volpath ? "volpath" : "path");
    for (const pugi::xml_document* part : {&view, &materials, &shapes, &lights}) append_all(root, *part);
    std::ostringstream text;
    document.save(text, "    ");
    scene.xml = text.str();
    scene.files = file.files();
    return scene;
}

}  // namespace mote::core
