// The exported folder: the scene, its files, and the list of what was dropped.
#include <array>
#include <cstring>
#include <filesystem>
#include <pugixml.hpp>
#include <sstream>

#include "apps/export/mitsuba_export.h"
#include "apps/output_files.h"
#include "core/image/image_file.h"

namespace mote::apps {

using core::Element;

namespace fs = std::filesystem;

namespace {

void add(pugi::xml_node parent, const Element& e) {
    pugi::xml_node node = parent.append_child(e.tag.c_str());
    for (const auto& [key, value] : e.attributes) node.append_attribute(key.c_str()) = value.c_str();
    for (const Element& c : e.children) add(node, c);
}

std::string xml_text(const Element& scene) {
    pugi::xml_document document;
    add(document, scene);
    std::ostringstream stream;
    document.save(stream, "    ");
    return stream.str();
}

void write_text(const fs::path& path, const std::string& text) {
    core::write_file_atomically(path.string(), std::as_bytes(std::span(text)));
}

class Bytes {
  public:
    template <typename T>
    void add(const T& value) {
        const auto* begin = reinterpret_cast<const char*>(&value);
        text_.append(begin, sizeof(T));
    }
    void add_text(const std::string& text) { text_ += text; }
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

/// "vertex_color" as r, g, b; "vertex_foo_color" as foo_r, foo_g, foo_b; "vertex_foo" as foo_x, foo_y, foo_z.
void add_attribute_properties(Bytes& bytes, const core::MeshData& mesh, bool of_faces) {
    for (const core::MeshAttribute& a : mesh.attributes) {
        if (a.of_faces != of_faces) continue;
        std::string stem = a.name.substr(a.name.find('_') + 1);
        const bool colour = stem == "color" || stem.ends_with("_color");
        if (colour) stem.resize(stem.size() - 5);
        for (const char* end : colour ? std::array{"r", "g", "b"} : std::array{"_x", "_y", "_z"})
            bytes.add_text("property float " + stem + end + "\n");
    }
}
void add_attribute_values(Bytes& bytes, const core::MeshData& mesh, bool of_faces, std::size_t i) {
    for (const core::MeshAttribute& a : mesh.attributes)
        for (int channel = 0; channel < 3 && a.of_faces == of_faces; ++channel)
            bytes.add(a.values[i][channel]);
}

/// Little-endian PLY, with the names that Mitsuba knows.
void write_ply(const fs::path& path, const core::MeshData& mesh) {
    Bytes bytes;
    bytes.add_text("ply\nformat binary_little_endian 1.0\nelement vertex " +
                   std::to_string(mesh.positions.size()) +
                   "\nproperty float x\nproperty float y\nproperty float z\n");
    if (!mesh.normals.empty()) bytes.add_text("property float nx\nproperty float ny\nproperty float nz\n");
    if (!mesh.uvs.empty()) bytes.add_text("property float u\nproperty float v\n");
    add_attribute_properties(bytes, mesh, false);
    bytes.add_text("element face " + std::to_string(mesh.triangles.size()) +
                   "\nproperty list uchar int vertex_indices\n");
    add_attribute_properties(bytes, mesh, true);
    bytes.add_text("end_header\n");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) bytes.add(mesh.positions[i][axis]);
        for (int axis = 0; axis < 3 && !mesh.normals.empty(); ++axis) bytes.add(mesh.normals[i][axis]);
        for (int axis = 0; axis < 2 && !mesh.uvs.empty(); ++axis) bytes.add(mesh.uvs[i][axis]);
        add_attribute_values(bytes, mesh, false, i);
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        bytes.add(std::uint8_t(3));
        for (const std::uint32_t vertex : mesh.triangles[i]) bytes.add(std::int32_t(vertex));
        add_attribute_values(bytes, mesh, true, i);
    }
    write_text(path, bytes.text());
}

std::string list_of(const std::vector<std::string>& notes) {
    if (notes.empty()) return "nothing was dropped or changed\n";
    std::string text;
    for (const std::string& note : notes) text += note + "\n";
    return text;
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw core::InputError("cannot be made: " + error.message(), {folder.string(), 0});
}

void copy_file(const std::string& from, const fs::path& to) {
    std::error_code error;
    if (fs::equivalent(from, to, error)) return;
    fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    if (error) throw core::InputError("cannot be copied: " + error.message(), {from, 0});
}

void check_files(const MitsubaExport& result, const fs::path& root) {
    std::vector<NamedFile> outputs;
    const auto add = [&](const std::string& name) {
        outputs.push_back({"'" + name + "' of the export", (root / name).string()});
    };
    add("scene.xml"), add("dropped.txt");
    for (const auto& [name, source] : result.copies)
        if (!same_file(source, (root / name).string())) add(name);  // else it stays as it is
    for (const auto& [name, grid] : result.grids) add(name);
    for (const auto& [name, mesh] : result.meshes) add(name);
    check_outputs(outputs, scene_inputs(result.inputs));
}

}  // namespace

void write_export(const MitsubaExport& result, const std::string& folder) {
    const fs::path root(folder);
    check_files(result, root);
    make_folder(root);
    const auto place = [&](const std::string& name) {
        make_folder((root / name).parent_path());
        return root / name;
    };
    for (const auto& [name, source] : result.copies) copy_file(source, place(name));
    for (const auto& [name, grid] : result.grids) media::write_vol_file(place(name).string(), grid);
    for (const auto& [name, mesh] : result.meshes) write_ply(place(name), mesh);
    write_text(root / "dropped.txt", list_of(result.notes));
    write_text(root / "scene.xml", xml_text(result.scene));
}

}  // namespace mote::apps
