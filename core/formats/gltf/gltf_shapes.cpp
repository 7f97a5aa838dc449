// Shapes, groups and instances.
#include "core/formats/gltf/gltf_shapes.h"

#include <algorithm>

#include "core/formats/gltf/gltf_mesh.h"
#include "core/formats/conversion/scene_xml.h"
#include "core/formats/meshes/ply_writer.h"
#include "core/geometry/mesh_checks.h"
#include "core/geometry/mesh_edits.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

Bounds3 bounds_of(const MeshData& mesh) {
    Bounds3 bounds;
    for (const Vec3& p : mesh.positions)
        if (is_finite(p)) bounds.extend(p);
    return bounds;
}

}  // namespace

void GltfShapes::add_part(Parts& parts, MeshData mesh, const std::string& name,
                          std::optional<std::size_t> material, bool turned) {
    if (mesh.triangles.empty()) return;
    const GltfMaterial& look = materials_.get(material);
    Part part;
    part.material = material, part.flat = mesh.normals.empty(), part.bounds = bounds_of(mesh);
    part.bsdf = materials_.bsdf(material, !mesh.attributes.empty(), turned);
    part.file = name + (turned ? "_turned" : "") + ".ply";
    part.two_lamps = look.emissive && look.double_sided && !is_closed(mesh);
    const std::string ply = ply_bytes(mesh);
    folder_.write(part.file, std::as_bytes(std::span(ply)));
    if (part.two_lamps) part.mesh = std::move(mesh);
    parts.push_back(std::move(part));
}

void GltfShapes::read_primitive(Parts& parts, const GltfValue& primitive, const std::string& name,
                                bool mirrored) {
    if (primitive["extensions"]["KHR_draco_mesh_compression"].present() ||
        primitive["extensions"]["EXT_meshopt_compression"].present())
        return report_.fault(primitive.place() + " is compressed, in a way that is not read", "left out");
    const auto material = primitive["material"].index_below(file_.root()["materials"].size());
    const GltfMaterial& look = materials_.get(material);
    auto mesh = read_gltf_primitive(file_, primitive, look.uv_set);
    if (!mesh) return report_.note(primitive.place() + " has no triangles, and is left out");
    check_mesh(*mesh, {file_.path(), 0});
    if (!has_area(*mesh)) return report_.note(primitive.place() + " has no area, and is left out");
    if (look.base_texture && !mesh->attributes.empty()) {
        report_.fault(
            primitive.place() + " has colours of its own and a texture, whose product does not exist here",
            "the texture counts");
        mesh->attributes.clear();
    }
    for (MeshAttribute& colours : mesh->attributes)
        for (Rgb& c : colours.values) c *= look.base_factor;
    if (!look.normal_map) return add_part(parts, std::move(*mesh), name, material, false);
    // The green of a normal map follows the picture, which a mirrored surface shows turned over.
    MeshByHandedness split = split_by_handedness(*mesh);
    add_part(parts, std::move(split.straight), name + (mirrored ? "_mirrored" : ""), material, mirrored);
    add_part(parts, std::move(split.turned), name + (mirrored ? "_mirrored" : ""), material, !mirrored);
}

/// `mirrored`: for a node that mirrors; where that makes no difference, the same parts again.
const GltfShapes::Parts& GltfShapes::parts_of(std::size_t mesh, bool mirrored) {
    const GltfValue value = file_.root()["meshes"].at(mesh), primitives = value["primitives"];
    bool differs = false;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const auto material = primitives.at(i)["material"].index_below(file_.root()["materials"].size());
        differs = differs || materials_.get(material).normal_map;
    }
    const std::pair key(mesh, mirrored && differs);
    if (const auto it = parts_.find(key); it != parts_.end()) return it->second;
    Parts& parts = parts_[key];
    for (std::size_t i = 0; i < primitives.size(); ++i)
        read_primitive(parts, primitives.at(i), "mesh_" + std::to_string(mesh) + "_" + std::to_string(i),
                       key.second);
    return parts;
}

void GltfShapes::add_shape(pugi::xml_node parent, const Part& part, const Transform* to_world) {
    pugi::xml_node shape = add_object(parent, "shape", "ply");
    add_value(shape, "string", "filename", prefix_ + part.file);
    if (part.flat) add_value(shape, "boolean", "face_normals", "true");
    if (to_world) add_transform(shape, "to_world", *to_world);
    add_ref(shape, part.bsdf);
    materials_.add_light_and_medium(shape, part.material);
    emits_ = emits_ || materials_.get(part.material).emissive;
    has_media_ = has_media_ || shape.child("medium");
}

/// Area lights shine to one side: of two sheets so close that it is not seen, one shines to the other side.
/// In world space, where rounding decides how close they may be.
void GltfShapes::add_back_lamp(pugi::xml_node parent, const Part& part, const Transform& to_world) {
    constexpr float gap = 1e-5f;
    MeshData mesh = part.mesh;
    transform_mesh(mesh, to_world);
    const Bounds3 box = bounds_of(mesh);
    const float reach = max_component(glm::max(glm::abs(box.lower), glm::abs(box.upper)));
    Part back = part;
    back.file = "back_" + std::to_string(copies_++) + ".ply";
    const std::string ply = ply_bytes(back_side(mesh, gap * reach));
    folder_.write(back.file, std::as_bytes(std::span(ply)));
    add_shape(parent, back, nullptr);
}

void GltfShapes::extend(const Part& part, const Transform& to_world) {
    for (int corner = 0; corner < 8; ++corner) {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = (corner >> axis) & 1 ? part.bounds.upper[axis] : part.bounds.lower[axis];
        bounds_.extend(Vec3(to_world.point(Vec3d(p))));
    }
}

void GltfShapes::place(pugi::xml_node scene, std::size_t mesh, const GltfNode& node, bool in_group) {
    const bool mirrored = node.to_world.determinant() < 0.0;
    const Parts& parts = parts_of(mesh, mirrored);
    if (parts.empty()) return;
    for (const Part& part : parts) extend(part, node.to_world);
    if (!in_group) {
        for (const Part& part : parts) {
            add_shape(scene, part, &node.to_world);
            if (part.two_lamps) add_back_lamp(scene, part, node.to_world);
        }
        return;
    }
    std::string& group = groups_[{mesh, parts.front().file != parts_of(mesh, false).front().file}];
    if (group.empty()) {
        group = "group_" + std::to_string(groups_.size() - 1);
        pugi::xml_node shapes = add_object(scene, "shape", "shapegroup", "", group);
        for (const Part& part : parts) add_shape(shapes, part, nullptr);
    }
    pugi::xml_node instance = add_object(scene, "shape", "instance");
    add_ref(instance, group);
    add_transform(instance, "to_world", node.to_world);
}

bool GltfShapes::can_be_instanced(std::size_t mesh) {
    const GltfValue primitives = file_.root()["meshes"].at(mesh)["primitives"];
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const auto material = primitives.at(i)["material"].index_below(file_.root()["materials"].size());
        if (materials_.get(material).emissive) return false;
    }
    return true;
}

void GltfShapes::add(pugi::xml_node scene, const std::vector<GltfNode>& nodes) {
    const std::size_t meshes = file_.root()["meshes"].size();
    std::map<std::size_t, int> uses;
    for (const GltfNode& node : nodes)
        if (const auto mesh = node.value["mesh"].index_below(meshes)) ++uses[*mesh];
    for (const GltfNode& node : nodes) {
        const auto mesh = node.value["mesh"].index_below(meshes);
        if (!mesh) continue;
        if (!node.to_world.valid()) {
            report_.note(node.value.title() + " is scaled to nothing, and is left out");
            continue;
        }
        place(scene, *mesh, node, uses[*mesh] > 1 && can_be_instanced(*mesh));
    }
}

}  // namespace mote::core
