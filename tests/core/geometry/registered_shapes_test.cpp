// Shapes as the scene language makes them: parameters, defaults, errors with a place.
#include "core/formats/register_formats.h"
#include "core/geometry/triangle_mesh.h"
#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

std::shared_ptr<Shape> make(const std::string& type, std::map<std::string, PropertyValue> values) {
    Registry registry;
    register_geometry(registry), register_assets(registry);
    Properties p;
    p.category = Category::shape, p.type = type, p.where = {"scene.xml", 12};
    for (auto& [name, value] : values) p.values[name] = {value, {"scene.xml", 13}};
    const Manual* manual = registry.find(Category::shape, type);
    REQUIRE(manual);
    const std::vector<Parameter>& rows = manual->parameters;
    for (const auto& value : values)
        CHECK(
            std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return row.name == value.first; }));
    return std::dynamic_pointer_cast<Shape>(registry.factory(Category::shape, type)(p));
}

}  // namespace

TEST_CASE("the shapes of the scene language", "[geometry][registry]") {
    Registry registry;
    register_geometry(registry), register_assets(registry);
    CHECK(registry.types(Category::shape) ==
          std::vector<std::string>{"bsplinecurve", "cube", "cylinder", "disk", "instance", "linearcurve",
                                   "mesh", "obj", "ply", "rectangle", "serialized", "shapegroup", "sphere"});
    CHECK(make("rectangle", {})->area() == Approx(4.0));
    CHECK(make("cube", {{"to_world", scaling(1, 2, 3)}})->area() == Approx(8.0 * 11.0));
    const auto sphere =
        make("sphere", {{"center", Vec3d(1, 2, 3)}, {"radius", 2.0}, {"to_world", scaling(3, 3, 3)}});
    CHECK(glm::length(sphere->bounds().center() - Vec3(3, 6, 9)) < 1e-5f);
    CHECK(make("disk", {})->area() == Approx(double(pi)));
    CHECK(make("cylinder", {{"p1", Vec3d(0, 0, 2)}, {"radius", 0.5}})->area() == Approx(2.0 * double(pi)));
    const auto flipped = make("rectangle", {{"flip_normals", true}});
    CHECK(flipped->sample_area({0.5f, 0.5f}).normal == Vec3(0, 0, -1));
}

TEST_CASE("bad shapes are refused where they stand", "[geometry][registry]") {
    CHECK_THROWS_WITH(make("sphere", {{"radius", -1.0}}), ContainsSubstring("scene.xml:13"));
    CHECK_THROWS_WITH(make("sphere", {{"to_world", scaling(1, 0, 1)}}), ContainsSubstring("singular"));
    CHECK_THROWS_WITH(make("cube", {{"to_world", scaling(1, 0, 1)}}), ContainsSubstring("singular"));
    CHECK_THROWS_WITH(make("obj", {}), ContainsSubstring("filename"));
    CHECK_THROWS_WITH(make("ply", {{"filename", std::string("/nowhere.ply")}}),
                      ContainsSubstring("nowhere.ply"));
}
