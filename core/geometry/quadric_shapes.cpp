// Shapes "sphere", "disk" and "cylinder", exact and without triangles.
#include "core/geometry/analytic_shapes.h"
#include "core/geometry/shape_plugins.h"

namespace mote::core {
namespace {

constexpr const char* similarity =
    "rotation, uniform scale, translation and mirroring; under others it stays a sphere, with a warning: its "
    "radius is scaled as x is, as in Mitsuba";

double radius_of(const Properties& p) {
    const double radius = p.get_float("radius", 1.0);
    if (!(radius > 0.0)) throw InputError("'radius' must be above 0", p.where_of("radius"));
    return radius;
}

std::shared_ptr<Object> sphere(const Properties& p) {
    return at_element(p, [&] {
        return make_sphere(p.get_vec3("center", Vec3d(0.0)), radius_of(p), p.get_transform(),
                           p.get_bool("flip_normals", false));
    });
}

std::shared_ptr<Object> disk(const Properties& p) {
    return at_element(p, [&] { return make_disk(p.get_transform(), p.get_bool("flip_normals", false)); });
}

std::shared_ptr<Object> cylinder(const Properties& p) {
    return at_element(p, [&] {
        return make_cylinder(p.get_vec3("p0", Vec3d(0.0)), p.get_vec3("p1", Vec3d(0.0, 0.0, 1.0)),
                             radius_of(p), p.get_transform(), p.get_bool("flip_normals", false));
    });
}

}  // namespace

void register_quadrics(Registry& registry) {
    registry.add({Category::shape,
                  "sphere",
                  "An exact sphere; as a light it is sampled through the cone that it fills.",
                  {{"center", "point", "0, 0, 0", "centre, before the transform [m]"},
                   {"radius", "float", "1", "radius, before the transform [m]"},
                   flip_normals_parameter(),
                   to_world_parameter(similarity)},
                  R"(<shape type="sphere">
    <point name="center" x="0" y="1" z="0"/>
    <float name="radius" value="0.5"/>
</shape>)"},
                 sphere);
    registry.add({Category::shape,
                  "disk",
                  "The disk of radius 1 around the origin in the xy plane, facing +z.",
                  {flip_normals_parameter(), to_world_parameter("any affine transform")},
                  R"(<shape type="disk">
    <transform name="to_world">
        <scale value="0.25"/>
    </transform>
</shape>)"},
                 disk);
    registry.add({Category::shape,
                  "cylinder",
                  "An exact cylinder without end caps, facing outwards.",
                  {{"p0", "point", "0, 0, 0", "centre of one end, before the transform [m]"},
                   {"p1", "point", "0, 0, 1", "centre of the other end, before the transform [m]"},
                   {"radius", "float", "1", "radius, before the transform [m]"},
                   flip_normals_parameter(),
                   to_world_parameter("any affine transform")},
                  R"(<shape type="cylinder">
    <point name="p1" x="0" y="2" z="0"/>
    <float name="radius" value="0.1"/>
</shape>)"},
                 cylinder);
}

}  // namespace mote::core
