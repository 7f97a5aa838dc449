// From accessors to MeshData.
#include "core/formats/gltf/gltf_mesh.h"

#include <algorithm>

#include "core/formats/gltf/gltf_accessor.h"
#include "core/geometry/mesh_edits.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

enum Mode : std::uint64_t { triangles = 4, triangle_strip = 5, triangle_fan = 6 };

/// Corners in the order of the file.
std::vector<std::uint32_t> corners_of(GltfFile& file, const GltfValue& primitive, std::size_t vertices) {
    std::vector<std::uint32_t> corners;
    const auto indices = primitive["indices"].index_below(file.root()["accessors"].size());
    if (!indices) {
        for (std::uint32_t i = 0; i < vertices; ++i) corners.push_back(i);
        return corners;
    }
    const GltfAccessor accessor(file, *indices);
    for (std::size_t i = 0; i < accessor.size(); ++i) {
        corners.push_back(accessor.whole(i));
        if (corners.back() >= vertices) primitive["indices"].refuse("name a vertex that is not there");
    }
    return corners;
}

/// glTF 2.0, Sec. 3.7.2.1.
std::vector<Triangle> triangles_of(const std::vector<std::uint32_t>& v, std::uint64_t mode) {
    std::vector<Triangle> list;
    for (std::size_t i = 0; i + 2 < v.size(); i += mode == triangles ? 3 : 1) {
        if (mode == triangle_fan)
            list.push_back({v[i + 1], v[i + 2], v[0]});
        else if (mode == triangle_strip)
            list.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
        else
            list.push_back({v[i], v[i + 1], v[i + 2]});
    }
    return list;
}

/// Keeps the vertices that triangles use: primitives often share one long list. Returns which they were.
std::vector<std::uint32_t> compact(std::vector<Triangle>& triangles, std::size_t vertices) {
    std::vector<std::uint32_t> new_index(vertices, UINT32_MAX), used;
    for (Triangle& t : triangles)
        for (std::uint32_t& corner : t) {
            std::uint32_t& index = new_index[corner];
            if (index == UINT32_MAX) index = std::uint32_t(used.size()), used.push_back(corner);
            corner = index;
        }
    return used;
}

std::optional<GltfAccessor> attribute(GltfFile& file, const GltfValue& primitive, const std::string& name,
                                      std::size_t vertices, int least, int most) {
    const GltfValue value = primitive["attributes"][name];
    const auto index = value.index_below(file.root()["accessors"].size());
    if (!index) return std::nullopt;
    GltfAccessor accessor(file, *index);
    if (accessor.components() < least || accessor.components() > most)
        value.refuse("has " + std::to_string(accessor.components()) + " components");
    if (accessor.size() < vertices) value.refuse("has fewer elements than there are vertices");
    return accessor;
}

Vec3 vec3(const GltfAccessor& a, std::size_t i) { return {a.value(i, 0), a.value(i, 1), a.value(i, 2)}; }

void add_colours(const GltfAccessor& accessor, const std::vector<std::uint32_t>& used, MeshData& mesh) {
    MeshAttribute colours{"vertex_color", false, {}};
    for (const std::uint32_t i : used) {
        const Rgb colour = vec3(accessor, i);
        colours.values.push_back(is_finite(colour) ? glm::clamp(colour, 0.0f, 1.0f) : Rgb(0.0f));
    }
    const auto white = [](const Rgb& c) { return c == Rgb(1.0f); };
    if (!std::all_of(colours.values.begin(), colours.values.end(), white))
        mesh.attributes.push_back(std::move(colours));
}

/// A part of the mesh: those of its triangles.
MeshData part_of(const MeshData& mesh, std::vector<Triangle> triangles) {
    MeshData part;
    const std::vector<std::uint32_t> used = compact(triangles, mesh.positions.size());
    part.triangles = std::move(triangles);
    for (const MeshAttribute& a : mesh.attributes) part.attributes.push_back({a.name, a.of_faces, {}});
    for (const std::uint32_t i : used) {
        part.positions.push_back(mesh.positions[i]);
        if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[i]);
        if (!mesh.uvs.empty()) part.uvs.push_back(mesh.uvs[i]);
        for (std::size_t a = 0; a < mesh.attributes.size(); ++a)
            part.attributes[a].values.push_back(mesh.attributes[a].values[i]);
    }
    return part;
}

}  // namespace

std::optional<MeshData> read_gltf_primitive(GltfFile& file, const GltfValue& primitive, std::size_t uv_set) {
    const std::uint64_t mode = primitive["mode"].whole(triangles);
    if (mode > triangle_fan) primitive["mode"].refuse("is no kind of primitive");
    if (mode < triangles) return std::nullopt;
    const auto positions = attribute(file, primitive, "POSITION", 0, 3, 3);
    if (!positions) return std::nullopt;
    const std::size_t vertices = positions->size();
    MeshData mesh;
    mesh.triangles = triangles_of(corners_of(file, primitive, vertices), mode);
    if (mesh.triangles.empty()) return std::nullopt;
    const std::vector<std::uint32_t> used = compact(mesh.triangles, vertices);
    const auto normals = attribute(file, primitive, "NORMAL", vertices, 3, 3);
    const auto uvs = attribute(file, primitive, "TEXCOORD_" + std::to_string(uv_set), vertices, 2, 2);
    const auto colours = attribute(file, primitive, "COLOR_0", vertices, 3, 4);
    for (const std::uint32_t i : used) {
        mesh.positions.push_back(vec3(*positions, i));
        if (normals) mesh.normals.push_back(vec3(*normals, i));
        if (uvs) mesh.uvs.emplace_back(uvs->value(i, 0), uvs->value(i, 1));
    }
    if (colours) add_colours(*colours, used, mesh);
    return mesh;
}

MeshByHandedness split_by_handedness(const MeshData& mesh) {
    if (mesh.uvs.empty()) return {mesh, {}};
    std::vector<Triangle> straight, turned;
    for (const Triangle& t : mesh.triangles) {
        const glm::dvec2 a(mesh.uvs[t[0]]), b = glm::dvec2(mesh.uvs[t[1]]) - a,
                                            c = glm::dvec2(mesh.uvs[t[2]]) - a;
        // Seen from in front corners go round counter-clockwise; with v down that is a negative area.
        (b.x * c.y - b.y * c.x > 0.0 ? turned : straight).push_back(t);
    }
    if (turned.empty()) return {mesh, {}};
    if (straight.empty()) return {{}, mesh};
    return {part_of(mesh, std::move(straight)), part_of(mesh, std::move(turned))};
}

}  // namespace mote::core
