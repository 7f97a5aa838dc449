// Triangle meshes as PLY.
#include "core/formats/meshes/ply_writer.h"

#include <array>
#include <cstring>

namespace mote::core {
namespace {

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
void add_attribute_properties(Bytes& bytes, const MeshData& mesh, bool of_faces) {
    for (const MeshAttribute& a : mesh.attributes) {
        if (a.of_faces != of_faces) continue;
        std::string stem = a.name.substr(a.name.find('_') + 1);
        const bool colour = stem == "color" || stem.ends_with("_color");
        if (colour) stem.resize(stem.size() - 5);
        for (const char* end : colour ? std::array{"r", "g", "b"} : std::array{"_x", "_y", "_z"})
            bytes.add_text("property float " + stem + end + "\n");
    }
}
void add_attribute_values(Bytes& bytes, const MeshData& mesh, bool of_faces, std::size_t i) {
    for (const MeshAttribute& a : mesh.attributes)
        for (int channel = 0; channel < 3 && a.of_faces == of_faces; ++channel)
            bytes.add(a.values[i][channel]);
}

}  // namespace

std::string ply_bytes(const MeshData& mesh) {
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
    return bytes.text();
}

}  // namespace mote::core
