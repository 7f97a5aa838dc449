// Shapes "rectangle" and "cube": small meshes without a file.
#include "core/geometry/mesh_edits.h"
#include "core/geometry/shape_plugins.h"

namespace mote::core {
namespace {

template <MeshData (*Make)()>
std::shared_ptr<Object> make_primitive(const ShapePlacement& place, const Properties& p) {
    return at_element(p, [&] {
        MeshData data = Make();
        transform_mesh(data, place.to_world);
        if (place.flip_normals) flip_orientation(data);
        return std::make_shared<TriangleMesh>(std::move(data));
    });
}

}  // namespace

void register_primitives(Registry& registry) {
    add_type(registry, Category::shape, "rectangle",
             "The square [-1, 1] x [-1, 1] in the xy plane, facing +z.", placement_rows(),
             R"(<shape type="rectangle">
    <transform name="to_world">
        <scale value="2"/>
    </transform>
</shape>)",
             make_primitive<make_rectangle>);
    add_type(registry, Category::shape, "cube",
             "The cube [-1, 1]^3, facing outwards. Each face has texture coordinates of its own.",
             placement_rows(), R"(<shape type="cube">
    <transform name="to_world">
        <translate y="1"/>
    </transform>
</shape>)",
             make_primitive<make_cube>);
}

}  // namespace mote::core
