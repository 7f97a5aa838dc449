// Shapes "shapegroup" and "instance": geometry that is described once and stands in the scene many times.
#include "core/geometry/instances.h"
#include "core/geometry/shape_plugins.h"

namespace mote::core {
namespace {

struct GroupSettings {
    std::vector<Nested<Object>> shapes;
};

std::shared_ptr<Object> shape_group(const GroupSettings& settings, const Properties& p) {
    auto group = std::make_shared<ShapeGroup>();
    for (const auto& child : settings.shapes) {
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

struct InstanceSettings {
    std::vector<Nested<Object>> groups;
    Transform to_world;
};

std::shared_ptr<Object> instance(const InstanceSettings& settings, const Properties& p) {
    if (settings.groups.size() != 1)
        throw InputError("an instance places one shapegroup: name it with <ref>", p.where);
    auto group = std::dynamic_pointer_cast<ShapeGroup>(settings.groups[0].object);
    if (!group)
        throw InputError("only a shapegroup can be instanced: put the shape into one",
                         settings.groups[0].where);
    auto result = std::make_shared<Instance>();
    result->shapes = place_group(std::move(group), settings.to_world, p.where_of("to_world"));
    return result;
}

}  // namespace

void register_instances(Registry& registry) {
    add_type<GroupSettings>(
        registry, Category::shape, "shapegroup",
        "Shapes that instances place, all together; they are not in the scene themselves. A group holds no "
        "lights, no groups and no instances. Materials and media are those of its shapes.",
        {nested("shape", &GroupSettings::shapes, Category::shape, "none", "Any number of nested shapes.")},
        R"(<shape type="shapegroup" id="lantern">
    <shape type="cylinder">
        <float name="radius" value="0.4"/>
    </shape>
    <shape type="disk"/>
</shape>)",
        shape_group);
    add_type<InstanceSettings>(registry, Category::shape, "instance",
                               "A shapegroup placed in the scene. Its meshes are in memory once, however "
                               "many instances there are. It takes no BSDF, light or medium of its own.",
                               {nested("shapegroup", &InstanceSettings::groups, Category::shape, "required",
                                       "The group, mostly a <ref>."),
                                row("to_world", &InstanceSettings::to_world,
                                    "Any affine transform that can be inverted in single precision; the "
                                    "outside stays outside.")},
                               R"(<shape type="instance">
    <shape type="shapegroup">
        <shape type="cube"/>
    </shape>
    <transform name="to_world">
        <scale x="-1" y="2" z="0.5"/>
    </transform>
</shape>)",
                               instance);
}

}  // namespace mote::core
