// Shapes "shapegroup" and "instance": geometry that is described once and stands in the scene many times.
#include "core/geometry/instances.h"
#include "core/geometry/shape_plugins.h"

namespace mote::core {
namespace {

std::shared_ptr<Object> shape_group(const Properties& p) {
    auto group = std::make_shared<ShapeGroup>();
    for (const Properties::Child& child : p.children) {
        if (std::dynamic_pointer_cast<ShapeGroup>(child.object))
            throw InputError("a shapegroup cannot hold another one", child.where);
        if (std::dynamic_pointer_cast<Instance>(child.object))
            throw InputError("instances cannot be nested: a shapegroup holds no instance", child.where);
        auto shape = std::dynamic_pointer_cast<Shape>(child.object);
        if (!shape) throw InputError("a shapegroup holds shapes only", child.where);
        if (shape->emitter)
            throw InputError("a light cannot be instanced: its shape must stand outside of the shapegroup",
                             child.where);
        group->shapes.push_back(std::move(shape));
    }
    if (group->shapes.empty()) p.warn("this shapegroup is empty");
    return group;
}

std::shared_ptr<Object> instance(const Properties& p) {
    if (p.children.size() != 1)
        throw InputError("an instance places one shapegroup: name it with <ref>", p.where);
    const Properties::Child& child = p.children.front();
    auto group = std::dynamic_pointer_cast<ShapeGroup>(child.object);
    if (!group) throw InputError("only a shapegroup can be instanced: put the shape into one", child.where);
    auto result = std::make_shared<Instance>();
    try {
        result->shapes = place_group(std::move(group), p.get_transform());
    } catch (const InputError& error) {
        throw InputError(error.what(), p.has("to_world") ? p.where_of("to_world") : p.where);
    }
    return result;
}

}  // namespace

void register_instances(Registry& registry) {
    registry.add({Category::shape,
                  "shapegroup",
                  "Shapes that instances place, all together; they are not in the scene themselves. A group "
                  "holds no lights, no groups and no instances. Materials and media are those of its shapes.",
                  {{"shape", "shape", "", "any number of nested shapes"}},
                  R"(<shape type="shapegroup" id="lantern">
    <shape type="cylinder">
        <float name="radius" value="0.4"/>
    </shape>
    <shape type="disk"/>
</shape>)"},
                 shape_group);
    registry.add(
        {Category::shape,
         "instance",
         "A shapegroup placed in the scene. Its meshes are in memory once, however many instances "
         "there are. It takes no BSDF, light or medium of its own.",
         {{"shapegroup", "shape", "", "the group, mostly a <ref>"},
          to_world_parameter("any affine transform that can be inverted; the outside stays outside")},
         R"(<shape type="instance">
    <shape type="shapegroup">
        <shape type="cube"/>
    </shape>
    <transform name="to_world">
        <scale x="-1" y="2" z="0.5"/>
    </transform>
</shape>)"},
        instance);
}

}  // namespace mote::core
