// Shapes "sphere", "disk" and "cylinder", exact and without triangles.
#include "core/geometry/analytic_shapes.h"
#include "core/geometry/shape_plugins.h"

namespace mote::core {

void register_quadrics(Registry& registry) {
    struct Sphere : ShapePlacement {
        Vec3d center{0.0};
        double radius = 1.0;
    };
    add_type<Sphere>(
        registry, Category::shape, "sphere",
        "An exact sphere; as a light it is sampled through the cone that it fills.",
        {point_row("center", &Sphere::center, "m", "Centre, before the transform."),
         row("radius", &Sphere::radius, above(0, "m"), "Radius, before the transform."),
         placement_rows(
             "Rotation, uniform scale, translation and mirroring; under others it stays a sphere, with a "
             "warning: its radius is scaled as x is, as in Mitsuba.")},
        R"(<shape type="sphere">
    <point name="center" x="0" y="1" z="0"/>
    <float name="radius" value="0.5"/>
</shape>)",
        [](const Sphere& s, const Properties& p) {
            return at_element(p, [&] { return make_sphere(s.center, s.radius, s.to_world, s.flip_normals); });
        });
    add_type(registry, Category::shape, "disk",
             "The disk of radius 1 around the origin in the xy plane, facing +z.", placement_rows(),
             R"(<shape type="disk">
    <transform name="to_world">
        <scale value="0.25"/>
    </transform>
</shape>)",
             [](const ShapePlacement& s, const Properties& p) {
                 return at_element(p, [&] { return make_disk(s.to_world, s.flip_normals); });
             });
    struct Cylinder : ShapePlacement {
        Vec3d p0{0.0}, p1{0.0, 0.0, 1.0};
        double radius = 1.0;
    };
    add_type<Cylinder>(
        registry, Category::shape, "cylinder", "An exact cylinder without end caps, facing outwards.",
        {point_row("p0", &Cylinder::p0, "m", "Centre of one end, before the transform."),
         point_row("p1", &Cylinder::p1, "m", "Centre of the other end, before the transform."),
         row("radius", &Cylinder::radius, above(0, "m"), "Radius, before the transform."), placement_rows()},
        R"(<shape type="cylinder">
    <point name="p1" x="0" y="2" z="0"/>
    <float name="radius" value="0.1"/>
</shape>)",
        [](const Cylinder& s, const Properties& p) {
            return at_element(
                p, [&] { return make_cylinder(s.p0, s.p1, s.radius, s.to_world, s.flip_normals); });
        });
}

}  // namespace mote::core
