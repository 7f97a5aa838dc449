// Shapes "rectangle" and "cube": small meshes without a file.
#include "core/geometry/mesh_edits.h"
#include "core/geometry/shape_plugins.h"

namespace mote::core {
namespace {

std::shared_ptr<Object> make_primitive(const Properties& p, MeshData data) {
    const Transform to_world = p.get_transform();
    if (!to_world.valid())
        throw InputError("the transform is singular or not finite", p.where_of("to_world"));
    return at_element(p, [&] {
        transform_mesh(data, to_world);
        if (p.get_bool("flip_normals", false)) flip_orientation(data);
        return std::make_shared<TriangleMesh>(std::move(data));
    });
}

}  // namespace

void register_primitives(Registry& registry) {
    registry.add({Category::shape,
                  "rectangle",
                  "The square [-1, 1] x [-1, 1] in the xy plane, facing +z.",
                  {flip_normals_parameter(), to_world_parameter("any affine transform")},
                  R"(<shape type="rectangle">
    <transform name="to_world">
        <scale value="2"/>
    </transform>
</shape>)"},
                 [](const Properties& p) { return make_primitive(p, make_rectangle()); });
    registry.add({Category::shape,
                  "cube",
                  "The cube [-1, 1]^3, facing outwards. Each face has texture coordinates of its own.",
                  {flip_normals_parameter(), to_world_parameter("any affine transform")},
                  R"(<shape type="cube">
    <transform name="to_world">
        <translate y="1"/>
    </transform>
</shape>)"},
                 [](const Properties& p) { return make_primitive(p, make_cube()); });
}

}  // namespace mote::core
