// Shapes by type.
#include "core/formats/pbrt/pbrt_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/formats/conversion/scene_xml.h"
#include "core/formats/meshes/mesh_file.h"
#include "core/formats/meshes/ply_writer.h"
#include "core/formats/pbrt/pbrt_curves.h"
#include "core/formats/pbrt/pbrt_lights.h"
#include "core/formats/pbrt/pbrt_meshes.h"
#include "core/geometry/mesh_checks.h"
#include "core/geometry/mesh_edits.h"

namespace mote::core {
namespace {

/// Rotation, even scale and mirroring.
bool is_similarity(const Transform& t) {
    const glm::dmat3 m(t.matrix), gram = glm::transpose(m) * m;
    const double scale = gram[0][0];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(std::fabs(gram[i][j] - (i == j ? scale : 0.0)) <= 1e-6 * scale)) return false;
    return true;
}

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

/// Properties of vertices in the header of a PLY file.
bool has_normals(const std::string& ply) {
    const std::string header = ply.substr(0, std::min(ply.find("end_header"), std::size_t(4096)));
    return header.find(" nx") != std::string::npos;
}

/// In pbrt every triangle or patch of a mesh is a light of its own that has the power given; here each has
/// the mean of their radiances.
std::size_t lights_of(const PbrtObject& shape, const MeshData& mesh) {
    if (shape.type == "bilinearmesh") return std::max<std::size_t>(shape.numbers("indices").size() / 4, 1);
    const bool quadric = shape.type == "sphere" || shape.type == "disk" || shape.type == "cylinder";
    return quadric ? 1 : mesh.triangles.size();
}

}  // namespace

bool PbrtShapes::shines(const PbrtShapeState& state) const { return state.light && object_.empty(); }

std::string PbrtShapes::material_of(const PbrtObject& shape, const PbrtShapeState& state) {
    const PbrtTexturePtr alpha = textures_.find(shape, "alpha", false);
    if (!alpha || (alpha->constant() && alpha->value({}).x >= 1.0f)) return state.material;
    if (!shines(state)) return materials_.with_holes(state.material, alpha);
    files_.fault(shape.where, "a light with holes (alpha) has no counterpart here",
                 "it has none, and is seen");
    return state.material;
}

/// Orientation, BSDF, media and light of a shape. `area`: in the world.
void PbrtShapes::add_appearance(pugi::xml_node element, const PbrtObject& shape, const PbrtShapeState& state,
                                double area) {
    if (state.reverse_orientation) add_value(element, "boolean", "flip_normals", "true");
    const std::string material = material_of(shape, state);
    materials_.use(material);
    add_ref(element, material);
    if (state.inside != state.outside) {
        if (!state.inside.empty()) add_ref(element, state.inside, "interior");
        if (!state.outside.empty()) add_ref(element, state.outside, "exterior");
    }
    if (shines(state)) add_pbrt_area_light(element, *state.light, area, exposure_, textures_, files_);
    if (state.light && in_object())
        files_.note("area lights of objects that are instanced emit nothing, as in pbrt");
}

void PbrtShapes::add_sphere(const PbrtObject& shape, const PbrtShapeState& state) {
    const double r = shape.number("radius", 1.0);
    const bool whole = shape.number("zmin", -r) <= -r && shape.number("zmax", r) >= r &&
                       shape.number("phimax", 360.0) >= 360.0;
    if (!whole || !is_similarity(state.to_world)) return add_mesh(pbrt_quadric(shape), shape, state);
    pugi::xml_node element = add_object(parent(), "shape", "sphere");
    add_float(element, "radius", r);
    add_transform(element, "to_world", state.to_world);
    const double world_radius = r * std::cbrt(std::fabs(state.to_world.determinant()));
    add_appearance(element, shape, state, 4.0 * std::numbers::pi * world_radius * world_radius);
}

void PbrtShapes::add_disk(const PbrtObject& shape, const PbrtShapeState& state) {
    const double r = shape.number("radius", 1.0), height = shape.number("height", 0.0);
    const bool whole = shape.number("innerradius", 0.0) <= 0.0 && shape.number("phimax", 360.0) >= 360.0;
    if (!whole || pbrt_is_two_sided(state.light)) return add_mesh(pbrt_quadric(shape), shape, state);
    pugi::xml_node element = add_object(parent(), "shape", "disk");
    const glm::dmat4 local = glm::scale(glm::translate(glm::dmat4(1.0), {0.0, 0.0, height}), {r, r, 1.0});
    const Transform to_world = state.to_world * Transform(local);
    add_transform(element, "to_world", to_world);
    const double square = glm::length(glm::cross(to_world.vector({1, 0, 0}), to_world.vector({0, 1, 0})));
    add_appearance(element, shape, state, std::numbers::pi * square);
}

void PbrtShapes::add_cylinder(const PbrtObject& shape, const PbrtShapeState& state) {
    const double r = shape.number("radius", 1.0), z0 = shape.number("zmin", -1.0),
                 z1 = shape.number("zmax", 1.0);
    if (shape.number("phimax", 360.0) < 360.0 || pbrt_is_two_sided(state.light) ||
        !is_similarity(state.to_world))
        return add_mesh(pbrt_quadric(shape), shape, state);
    pugi::xml_node element = add_object(parent(), "shape", "cylinder");
    add_float(element, "radius", r);
    add_value(element, "point", "p0", vector_text({0, 0, z0})),
        add_value(element, "point", "p1", vector_text({0, 0, z1}));
    add_transform(element, "to_world", state.to_world);
    const double scale = std::cbrt(std::fabs(state.to_world.determinant()));
    add_appearance(element, shape, state, 2.0 * std::numbers::pi * r * std::fabs(z1 - z0) * scale * scale);
}

pugi::xml_node PbrtShapes::add_file(const std::string& in_xml, bool faceted, const Transform* to_world) {
    pugi::xml_node element = add_object(parent(), "shape", "ply");
    add_value(element, "string", "filename", in_xml);
    if (faceted) add_value(element, "boolean", "face_normals", "true");
    if (to_world) add_transform(element, "to_world", *to_world);
    return element;
}

void PbrtShapes::add_ply(const PbrtObject& shape, const PbrtShapeState& state) {
    const PbrtParameter* file = shape.find("filename");
    const std::string name = shape.text("filename", "");
    shape.ignore({"edgelength"});
    if (!file) throw InputError("a plymesh needs a filename", shape.where);
    if (shape.find("displacement"))
        files_.fault(shape.where, "displaced meshes have no counterpart here", "the mesh stands undisplaced");
    const std::string path = files_.find(name, file->where), ply = read_pbrt_file(path);
    if (shines(state)) return add_mesh(read_ply(ply, path, false).data, shape, state);
    std::string in_xml;
    if (path.ends_with(".gz")) {
        const std::string unpacked = files_.new_name("mesh", ".ply");
        files_.write(unpacked, bytes_of(ply)), in_xml = files_.in_xml(unpacked);
    } else {
        in_xml = files_.use(name, file->where);
    }
    add_appearance(add_file(in_xml, !has_normals(ply), &state.to_world), shape, state, 0.0);
}

/// An area light emits to one side: of two sheets so close that it is not seen, one emits to the other side.
void PbrtShapes::add_other_side(MeshData mesh, const PbrtShapeState& state, const std::string& material,
                                double area) {
    constexpr float gap = 1e-5f;
    transform_mesh(mesh, state.to_world);
    if (state.reverse_orientation) flip_orientation(mesh);
    float reach = 0.0f;
    for (const Vec3& p : mesh.positions) reach = std::fmax(reach, max_component(glm::abs(p)));
    const std::string name = files_.new_name("back", ".ply"), ply = ply_bytes(back_side(mesh, gap * reach));
    files_.write(name, bytes_of(ply));
    pugi::xml_node element = add_file(files_.in_xml(name), mesh.normals.empty(), nullptr);
    materials_.use(material);
    add_ref(element, material);
    add_pbrt_area_light(element, *state.light, area, exposure_, textures_, files_);
}

void PbrtShapes::add_mesh(MeshData mesh, const PbrtObject& shape, const PbrtShapeState& state) {
    check_mesh(mesh, shape.where);
    if (!has_area(mesh)) return files_.note("a mesh without area is left out");
    const std::string name = files_.new_name("mesh", ".ply"), ply = ply_bytes(mesh);
    files_.write(name, bytes_of(ply));
    double area = 0.0;
    if (shines(state)) {
        MeshData in_world = mesh;
        transform_mesh(in_world, state.to_world);
        area = mesh_area(in_world) / double(lights_of(shape, mesh));
    }
    add_appearance(add_file(files_.in_xml(name), mesh.normals.empty(), &state.to_world), shape, state, area);
    if (shines(state) && pbrt_is_two_sided(state.light) && !is_closed(mesh))
        add_other_side(std::move(mesh), state, state.material, area);
}

void PbrtShapes::add_curve(const PbrtObject& shape, const PbrtShapeState& state) {
    if (shines(state)) files_.fault(shape.where, "curves emit no light here", "they are dark");
    curves_[material_of(shape, state)] += pbrt_curve_text(shape, state.to_world, files_);
}

void PbrtShapes::add(const PbrtObject& shape, const PbrtShapeState& state) {
    if (!state.to_world.valid()) return files_.note("a shape is scaled to nothing, and is left out");
    const std::string& type = shape.type;
    if (type == "sphere")
        add_sphere(shape, state);
    else if (type == "disk")
        add_disk(shape, state);
    else if (type == "cylinder")
        add_cylinder(shape, state);
    else if (type == "trianglemesh")
        add_mesh(pbrt_triangle_mesh(shape), shape, state);
    else if (type == "bilinearmesh")
        add_mesh(pbrt_bilinear_mesh(shape), shape, state);
    else if (type == "loopsubdiv")
        add_mesh(pbrt_loop_subdivision(shape), shape, state);
    else if (type == "plymesh")
        add_ply(shape, state);
    else if (type == "curve")
        add_curve(shape, state);
    else {
        static const std::vector<std::string> known = {
            "sphere", "disk", "cylinder", "trianglemesh", "bilinearmesh", "loopsubdiv", "plymesh", "curve"};
        throw InputError("unknown shape '" + printable(type, 40) + "'" + suggestion(type, known),
                         shape.where);
    }
    for (const InputError& error : shape.unknown()) files_.fault(error, "ignored");
}

void PbrtShapes::flush_curves() {
    for (const auto& [material, text] : curves_) {
        const std::string name = files_.new_name("curves", ".txt");
        files_.write(name, bytes_of(text));
        pugi::xml_node element = add_object(parent(), "shape", "bsplinecurve");
        add_value(element, "string", "filename", files_.in_xml(name));
        materials_.use(material);
        add_ref(element, material);
    }
    curves_.clear();
}

void PbrtShapes::begin_object(const std::string& name, const SourceLocation& where) {
    flush_curves();
    if (in_object()) throw InputError("an object begins inside of another", where);
    if (groups_.count(name))
        throw InputError("the object '" + printable(name, 60) + "' is defined twice", where);
    if (name.empty()) throw InputError("an object has no name", where);
    const std::string id = "object_" + std::to_string(groups_.size());
    object_ = name;
    groups_[name] = {add_object(scene_, "shape", "shapegroup", "", id), id};
}

void PbrtShapes::end_object() {
    flush_curves();
    object_.clear();
}

void PbrtShapes::add_instance(const std::string& name, const Transform& to_world,
                              const SourceLocation& where) {
    if (in_object()) throw InputError("an object holds instances of objects", where);
    instances_.push_back({name, to_world, where});
}

void PbrtShapes::finish() {
    end_object();
    for (const Instance& instance : instances_) {
        const auto it = groups_.find(instance.name);
        if (it == groups_.end()) {
            std::vector<std::string> known;
            for (const auto& [name, group] : groups_) known.push_back(name);
            files_.fault(instance.where,
                         "there is no object '" + printable(instance.name, 60) + "'" +
                             suggestion(instance.name, known),
                         "left out");
        } else if (!it->second.node.first_child() || !instance.to_world.valid()) {
            files_.note("instances without a shape are left out");
        } else {
            pugi::xml_node element = add_object(scene_, "shape", "instance");
            add_ref(element, it->second.id);
            add_transform(element, "to_world", instance.to_world);
        }
    }
    for (const auto& [name, group] : groups_)
        if (!group.node.first_child()) scene_.remove_child(group.node);
}

}  // namespace mote::core
