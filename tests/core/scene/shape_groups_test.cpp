// Groups, instances, curves and mesh attributes in the scene language: what they make, and what is refused
// with file and line.
#include <fstream>

#include "core/geometry/instances.h"
#include "core/scene/requirements.h"
#include "tests/core/scene/scene_fixture.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

std::string instance(const std::string& id, const std::string& transform = "") {
    return "<shape type='instance'><ref id='" + id + "'/>" +
           (transform.empty() ? "" : "<transform name='to_world'>" + transform + "</transform>") +
           "</shape>\n";
}
std::string group(const std::string& content) {
    return "<shape type='shapegroup' id='g'>" + content + "</shape>\n";
}
float sigma_at(const Scene& scene, const Vec3& p) {
    const Medium* medium = scene.medium_state_at(p, nullptr).current();
    return medium ? dynamic_cast<const FakeMedium&>(*medium).sigma_t.x : 0.0f;
}
void write(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
    std::ofstream(folder.file(name)) << text;
}

}  // namespace

TEST_CASE("a group is seen where instances place it, and nowhere else", "[scene][instances]") {
    const auto scene =
        load_body(group("<shape type='sphere'/><shape type='cube'/>") + instance("g", "<translate x='10'/>") +
                  instance("g", "<scale x='-2'/><translate x='20'/>"));
    REQUIRE(scene->shapes().size() == 4);
    CHECK(scene->shapes()[3]->index == 3);
    const auto seen = [&](const Vec3& from) { return scene->first_hit({from, {0, 0, -1}, 0.0f, infinity}); };
    CHECK_FALSE(seen({0, 0, 5}));
    CHECK(seen({10, 0, 5}));
    CHECK(seen({21.9f, 0, 5}));
    CHECK(find_requirements(*scene).triangles == 24);
    CHECK(find_requirements(*scene).analytic_shapes == 2);
}

TEST_CASE("media within instances: boundaries are counted there", "[scene][instances][media]") {
    // Shells of fog: a ball of fog, in which stands a cube without any.
    const std::string fog =
        "<medium type='homogeneous' id='a'><float name='sigma_t' value='2'/></medium>"
        "<medium type='homogeneous' id='none'><float name='sigma_t' value='0'/></medium>";
    const auto scene =
        load_body(fog +
                  group("<shape type='sphere'><bsdf type='null'/><ref name='interior' id='a'/></shape>"
                        "<shape type='cube'><transform name='to_world'><scale value='0.3'/></transform><bsdf "
                        "type='null'/>"
                        "<ref name='interior' id='none'/></shape>") +
                  instance("g", "<scale x='-1' y='2' z='3'/><rotate y='1' angle='30'/><translate x='10'/>") +
                  instance("g"));
    for (const float x : {0.0f, 10.0f}) {
        CHECK(sigma_at(*scene, {x + 0.7f, 0, 0}) == 2.0f);
        CHECK(sigma_at(*scene, {x, 0, 0}) == 0.0f);
        CHECK(sigma_at(*scene, {x + 0.1f, 5, 0}) == 0.0f);
    }
    CHECK(sigma_at(*scene, {10, 1.5f, 0}) == 2.0f);
    CHECK(sigma_at(*scene, {0, 1.5f, 0}) == 0.0f);
    // From outside through both shells: 2 x 2 x (1 - 0.3) of the ball of radius 1.
    Rng rng(1);
    TrackingCounters counters;
    const Vec3 from(-3, 0.01f, 0.02f), to(3, 0.01f, 0.02f);
    const float through =
        scene->transmittance(from, to, scene->medium_state_at(from, nullptr), rng, counters).x;
    CHECK(through == Approx(std::exp(-2.0 * 2.0 * 0.7)).epsilon(2e-3));
}

TEST_CASE("groups and instances that cannot be are refused where they stand", "[scene][instances]") {
    const auto refused = [](const std::string& body, const std::string& what) {
        INFO(body);
        CHECK_THROWS_WITH(load_body(body), ContainsSubstring(what) && ContainsSubstring(":"));
    };
    refused(group("<shape type='sphere'><emitter type='area'/></shape>"), "light cannot be instanced");
    refused(group("<shape type='shapegroup'><shape type='cube'/></shape>"), "cannot hold another");
    refused(group("<shape type='cube'/>") + "<shape type='shapegroup'>" + instance("g") + "</shape>",
            "cannot be nested");
    refused(group("<shape type='cube'/><bsdf type='diffuse'/>"), "takes no bsdf");
    refused(
        group("<shape type='cube'/>") + "<shape type='instance'><ref id='g'/><emitter type='area'/></shape>",
        "takes no emitter");
    refused("<shape type='instance'/>", "one shapegroup");
    refused("<shape type='cube' id='c'/>" + instance("c"), "only a shapegroup");
    refused(group("<shape type='cube'/>") + instance("g", "<scale x='0'/>"), "singular");
    refused(group("<shape type='cube'/>") + instance("g", "<scale value='1e-20'/>"),
            "test.xml:3: the transform of an instance is singular in single precision");
    refused(group("<shape type='cube'/>") + instance("g", "<scale x='1e-20'/>"),
            "test.xml:3: the transform of an instance is too small");
    refused(group("<shape type='cube'/>") + instance("g", "<scale x='1e-16'/>"),
            "test.xml:3: the transform of an instance is too small for this scene");
}

TEST_CASE("curves from files", "[scene][curves]") {
    const TemporaryFolder folder;
    const auto load = [&](const std::string& text, const std::string& more = "",
                          const char* type = "bsplinecurve") {
        write(folder, "c.txt", text);
        return load_body(std::string("<shape type='") + type + "'><string name='filename' value='" +
                         folder.file("c.txt") + "'/>" + more + "</shape>");
    };
    const std::string four = "0 0 0 .1\r\n1 0 0 .1\r\n2 0 0 .1\r\n3 0 0 .1\r\n";
    CHECK(load(four + "\n\n" + four + "4 0 0 .1")->shapes()[0]->primitive_count() == 3);
    CHECK(load("0 0 0 1\n1 0 0 1\n\n5 0 0 1\n6 0 0 1\n", "", "linearcurve")->shapes()[0]->primitive_count() ==
          2);
    // Radii stay as they are under to_world.
    const auto scaled = load(four, "<transform name='to_world'><scale value='10'/></transform>");
    CHECK(scaled->shapes()[0]->bounds().upper.y == Approx(0.1));
    CHECK_THROWS_WITH(load("0 0 0 .1\n1 0 0\n"), ContainsSubstring("c.txt:2: a control point is"));
    CHECK_THROWS_WITH(load("0 0 0 .1\n1 0 x .1\n"), ContainsSubstring("not 'x'"));
    CHECK_THROWS_WITH(load("0 0 0 .1\n1 0 0 .1\n\n" + four),
                      ContainsSubstring("needs 4 control points and has 2"));
    CHECK_THROWS_WITH(load("\n\n"), ContainsSubstring("no curve"));
    CHECK_THROWS_WITH(load("0 0 0 -1\n"), ContainsSubstring("c.txt:1: the radius"));
    CHECK_THROWS_WITH(load(four, "<emitter type='area'/>"), ContainsSubstring("cannot be a light"));
    CHECK_THROWS_WITH(load(four, "<medium type='homogeneous' name='interior'/>"),
                      ContainsSubstring("bounds no medium"));
}

TEST_CASE("shapes that use mesh attributes must have them", "[scene][attributes]") {
    const TemporaryFolder folder;
    write(folder, "m.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "property float r\nproperty float g\nproperty float b\nproperty float hot_r\nproperty float hot_g\n"
          "property float hot_b\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
          "0 0 0 1 0 0 9 9 9\n1 0 0 0 1 0 9 9 9\n0 1 0 0 0 1 9 9 9\n3 0 1 2\n");
    const std::string mesh =
        "<shape type='ply'><string name='filename' value='" + folder.file("m.ply") + "'/>";
    const auto bsdf = [](const std::string& name, const std::string& more = "") {
        return "<bsdf type='twosided'><bsdf type='diffuse'><texture type='mesh_attribute' name='reflectance'>"
               "<string name='name' value='" +
               name + "'/>" + more + "</texture></bsdf></bsdf></shape>";
    };
    const auto albedo = [](const Scene& scene, const Vec3& from) {
        const auto hit = scene.first_hit({from, {0, 0, -1}, 0.0f, infinity});
        REQUIRE(hit);
        return hit->shape->bsdf->albedo({hit->uv}, {0, 0, 1});
    };
    const auto scene = load_body(mesh + bsdf("vertex_color"));
    CHECK(glm::length(albedo(*scene, {0.25f, 0.5f, 1}) - Rgb(0.25f, 0.25f, 0.5f)) < 1e-5f);
    // Vertex colours through an instance.
    const auto placed = load_body(group(mesh + bsdf("vertex_color")) + instance("g", "<translate x='5'/>"));
    CHECK(glm::length(albedo(*placed, {5.25f, 0.5f, 1}) - Rgb(0.25f, 0.25f, 0.5f)) < 1e-5f);
    CHECK_THROWS_WITH(load_body(mesh + bsdf("vertex_colour")),
                      ContainsSubstring("no attribute 'vertex_colour'"));
    CHECK_THROWS_WITH(load_body("<shape type='sphere'>" + bsdf("vertex_color")),
                      ContainsSubstring("no attribute"));
    CHECK_THROWS_WITH(load_body(mesh + bsdf("color")), ContainsSubstring("'vertex_' or 'face_'"));
    CHECK_THROWS_WITH(load_body(mesh + bsdf("vertex_hot_color")), ContainsSubstring("from 9 to 9"));
    CHECK_NOTHROW(load_body(mesh + bsdf("vertex_hot_color", "<float name='scale' value='0.1'/>")));
}
