// Shapes: files are copied; meshes that Mitsuba would read or turn otherwise are written as we have them.
#include <filesystem>

#include "apps/export/export_context.h"
#include "core/formats/xml/scene_values.h"
#include "core/materials/bsdf.h"

namespace mote::apps {

using core::Element;

namespace {

/// A transform that mirrors turns Mitsuba's meshes and spheres inside out; ours keep the outside out.
bool mirrored(Element& shape) { return transform_of(shape, "to_world").determinant() < 0.0; }

/// Replaces the shape by a PLY file of its triangles in the world. So are meshes with attributes, for Mitsuba
/// takes colours that are integers as they are, and skips those of serialized files.
void write_mesh(Element& shape, const core::TriangleMesh& mesh, const ExportContext& context) {
    const std::string type = shape.get("type");
    const Element* file = shape.child("filename");
    const std::string stem = file ? std::filesystem::path(file->get("value")).stem().string() : type;
    const std::string name = context.free_name("meshes", stem, ".ply");
    context.result.meshes[name] = mesh.data();
    const std::string reason = !mesh.data().attributes.empty() ? "with attributes "
                               : type == "mesh"                ? ""
                                                               : "under a mirroring transform ";
    context.note(shape, "shape '" + type + "' " + reason + "became " + name);
    shape.set("type", "ply");
    for (const char* gone :
         {"filename", "face_normals", "flip_tex_coords", "shape_index", "flip_normals", "to_world"})
        remove_child(shape, gone);
    shape.children.push_back(shape.make_value("string", "filename", name));
    if (mesh.data().normals.empty())
        shape.children.push_back(shape.make_value("boolean", "face_normals", "true"));
}

/// A sphere is the same under a mirroring, but for its texture coordinates.
void write_mirrored_sphere(Element& shape, const ExportContext& context) {
    const core::Transform to_world = transform_of(shape, "to_world");
    const Element* center = shape.child("center");
    const Element* radius = shape.child("radius");
    std::vector<std::string> unused;
    const core::Vec3d c =
        center ? std::get<core::Vec3d>(core::parse_value(*center, false, unused)) : core::Vec3d(0.0);
    const double r = radius ? core::parse_number(radius->get("value"), radius->where) : 1.0;
    const core::Vec3d moved = to_world.point(c);
    remove_child(shape, "to_world");
    set_child(shape, shape.make_value("point", "center",
                                      core::number_to_text(moved.x) + ", " + core::number_to_text(moved.y) +
                                          ", " + core::number_to_text(moved.z)));
    set_child(shape, shape.make_value("float", "radius",
                                      core::number_to_text(r * std::cbrt(-to_world.determinant()))));
    context.note(shape, "a mirrored sphere lost its transform; its texture coordinates are turned");
}

/// Material of a shape without BSDF.
void write_default_bsdf(Element& element, const core::Shape& shape, const ExportContext& context) {
    for (const Element& c : element.children)
        if (core::resolve(c, context.ids).tag == "bsdf") return;
    Element bsdf = make_object(element, "bsdf", shape.bsdf->traits().null ? "null" : "diffuse", "");
    if (!shape.bsdf->traits().null)
        bsdf.children.push_back(make_rgb(element, "reflectance", core::Rgb(shape.emitter ? 0.0f : 0.5f)));
    element.children.push_back(bsdf);
}

bool overlap(const core::Bounds3& a, const core::Bounds3& b) {
    return glm::all(glm::lessThan(a.lower, b.upper)) && glm::all(glm::lessThan(b.lower, a.upper));
}

/// mote's exterior is all shapes that a point is inside of, and the medium around all of them; Mitsuba's
/// paths track the last shape that they crossed, and take what is outside of it to be empty unless it says
/// otherwise.
void write_exterior(Element& element, const core::Shape& shape, const ExportContext& context) {
    if (!shape.has_medium_boundary || shape.exterior) return;
    bool nested = false;
    for (const auto& other : context.scene.shapes())
        nested = nested || (other.get() != &shape && other->has_medium_boundary &&
                            overlap(shape.bounds(), other->bounds()));
    if (nested)
        context.note(element,
                     "its medium may lie within that of another shape: Mitsuba takes what is outside to "
                     "be empty unless the shape names its 'exterior'");
    else if (const core::Medium* outermost = context.scene.outermost_medium())
        element.children.push_back(make_reference(element, "exterior", outermost->id));
}

}  // namespace

void export_shape(Element& element, const core::Shape& shape, const core::Shape& placed,
                  const ExportContext& context) {
    write_default_bsdf(element, shape, context);
    write_exterior(element, placed, context);
    const auto* mesh = dynamic_cast<const core::TriangleMesh*>(&shape);
    if (mesh && (element.get("type") == "mesh" || mirrored(element) || !mesh->data().attributes.empty()))
        write_mesh(element, *mesh, context);
    else if (element.child("filename"))
        context.copy_file(element, "meshes");
    else if (element.get("type") == "sphere" && mirrored(element))
        write_mirrored_sphere(element, context);
}

}  // namespace mote::apps
