// Camera rays after the conventions of Mitsuba 3.
#include "core/scene/camera.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

std::unique_ptr<Scene> with_sensor(const std::string& type, const std::string& parameters, int width = 200,
                                   int height = 100) {
    return load_body("<sensor type='" + type + "'>" + parameters + "<film type='hdrfilm'>" +
                     "<integer name='width' value='" + std::to_string(width) + "'/>" +
                     "<integer name='height' value='" + std::to_string(height) + "'/></film></sensor>");
}

Ray ray_at(const Scene& scene, float x, float y, const Vec2& lens = Vec2(0.5f)) {
    const Ray ray = scene.camera().sample_ray({x, y}, lens);
    CHECK(glm::length(ray.direction) == Approx(1.0).epsilon(1e-6));
    return ray;
}

/// Tangent of the horizontal half angle: at the left edge, in the middle of the height.
double tan_x(const Scene& scene, int width, int height) {
    const Ray r = ray_at(scene, 0.0f, 0.5f * float(height));
    CHECK(r.direction.x > 0.0f);  // +X is to the picture's left
    CHECK(ray_at(scene, float(width), 0.5f * float(height)).direction.x == Approx(-r.direction.x));
    return double(r.direction.x / r.direction.z);
}

}  // namespace

TEST_CASE("Perspective: directions and clipping planes", "[scene][sensor]") {
    const auto scene = with_sensor("perspective",
                                   "<float name='fov' value='90'/>"
                                   "<float name='near_clip' value='0.5'/>"
                                   "<float name='far_clip' value='8'/>");
    const Ray centre = ray_at(*scene, 100, 50);
    CHECK(centre.direction.z == Approx(1.0));
    CHECK(centre.t_min == Approx(0.5));
    CHECK(centre.t_max == Approx(8.0));
    // top left corner: 45 degrees to the left, up by half of that tangent
    const Ray corner = ray_at(*scene, 0, 0);
    CHECK(corner.direction.x / corner.direction.z == Approx(1.0));
    CHECK(corner.direction.y / corner.direction.z == Approx(0.5));
    CHECK(corner.at(corner.t_min).z == Approx(0.5));
    CHECK(corner.at(corner.t_max).z == Approx(8.0));
}

TEST_CASE("Perspective: the axis of the field of view", "[scene][sensor]") {
    const auto tangent = [](const std::string& axis, int w, int h) {
        const auto scene =
            with_sensor("perspective",
                        "<float name='fov' value='60'/><string name='fov_axis' value='" + axis + "'/>", w, h);
        return tan_x(*scene, w, h);
    };
    const double t = std::tan(glm::radians(30.0));
    CHECK(tangent("x", 200, 100) == Approx(t));
    CHECK(tangent("y", 200, 100) == Approx(2.0 * t));
    CHECK(tangent("smaller", 200, 100) == Approx(2.0 * t));
    CHECK(tangent("larger", 200, 100) == Approx(t));
    CHECK(tangent("smaller", 100, 200) == Approx(t));
    CHECK(tangent("larger", 100, 200) == Approx(0.5 * t));
    // A diagonal of 3-4-5: the width is four fifths of it.
    CHECK(tangent("diagonal", 400, 300) == Approx(0.8 * t));
}

TEST_CASE("Perspective: focal length on 35 mm film", "[scene][sensor]") {
    // 36 x 24 mm at its own aspect: the half width is 18 mm.
    CHECK(tan_x(*with_sensor("perspective", "", 300, 200), 300, 200) == Approx(18.0 / 50.0));
    const auto tele = with_sensor("perspective", "<string name='focal_length' value='100mm'/>", 300, 200);
    CHECK(tan_x(*tele, 300, 200) == Approx(0.18));
}

TEST_CASE("Perspective: the world is where to_world puts it", "[scene][sensor]") {
    const auto scene = with_sensor(
        "perspective",
        "<transform name='to_world'><lookat origin='1 2 3' target='1 2 -5' up='0 1 0'/></transform>");
    CHECK(glm::length(scene->camera().position() - Vec3(1, 2, 3)) < 1e-6f);
    const Ray left = ray_at(*scene, 0, 50);
    CHECK(left.direction.x < 0.0f);  // looking along -z, left is -x
    CHECK(ray_at(*scene, 100, 0).direction.y > 0.0f);
}

TEST_CASE("Thin lens: sharp at the distance of focus", "[scene][sensor]") {
    const auto scene = with_sensor("thinlens",
                                   "<float name='fov' value='90'/><float name='aperture_radius' "
                                   "value='0.1'/><float name='focus_distance' value='4'/>");
    const Vec3 expected(2.0f, -0.5f, 4.0f);  // pixel (50, 62.5): tangents 0.5 and -0.125
    for (const Vec2& lens : {Vec2(0.01f, 0.3f), Vec2(0.99f, 0.8f), Vec2(0.4f, 0.05f)}) {
        const Ray r = ray_at(*scene, 50, 62.5f, lens);
        CHECK(r.origin.z == 0.0f);
        CHECK(glm::length(r.origin) <= 0.1f);
        CHECK(glm::length(r.origin) > 1e-3f);
        const Vec3 at_focus = r.at((4.0f - r.origin.z) / r.direction.z);
        CHECK(glm::length(at_focus - expected) < 1e-5f);
        CHECK(r.at(r.t_min).z == Approx(0.01));
    }
    CHECK(contains(load_error(scene_xml("<sensor type='thinlens'/>")),
                   "needs the parameter 'aperture_radius'"));
}

TEST_CASE("Orthographic: parallel rays, sized by a scale", "[scene][sensor]") {
    const auto scene =
        with_sensor("orthographic", "<transform name='to_world'><scale x='3' y='3'/></transform>");
    const Ray corner = ray_at(*scene, 0, 0);
    CHECK(corner.direction == Vec3(0, 0, 1));
    CHECK(corner.origin.x == Approx(3.0));
    CHECK(corner.origin.y == Approx(1.5));
    CHECK(ray_at(*scene, 200, 100).origin.x == Approx(-3.0));
    CHECK(corner.t_min == Approx(0.01));
}

TEST_CASE("Film, filter and sampler become settings", "[scene][sensor]") {
    const auto defaults = load_body("");
    CHECK(defaults->film().width == 768);
    CHECK(defaults->film().height == 576);
    CHECK(defaults->film().filter == "gaussian");
    CHECK(defaults->film().filter_stddev == 0.5f);
    CHECK(defaults->film().filter_radius == 2.0f);
    CHECK_FALSE(defaults->film().half);
    const auto scene = load_body(R"(<sensor type="perspective">
        <film type="hdrfilm"><rfilter type="tent"><float name="radius" value="1.5"/></rfilter>
            <string name="component_format" value="float16"/><string name="pixel_format" value="rgba"/></film>
        <sampler type="multijitter"><integer name="sample_count" value="8"/></sampler></sensor>)");
    CHECK(scene->film().filter == "tent");
    CHECK(scene->film().filter_radius == 1.5f);
    CHECK(scene->film().half);
    CHECK(scene->film().sampler == "sobol");
    CHECK(scene->film().sample_count == 8);
    REQUIRE(scene->parts().warnings.size() == 2);
    CHECK(contains(scene->parts().warnings[0], "test.xml:5: sampler 'multijitter' is replaced by 'sobol'"));
    CHECK(contains(scene->parts().warnings[1], "test.xml:3: 'pixel_format' of film 'hdrfilm' has no effect"));
}
