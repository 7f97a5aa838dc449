// One camera of every kind and attitude, for the tests of importance.
#pragma once

#include <fmt/format.h>

#include "core/loading/scene_loader.h"
#include "core/scene/camera.h"
#include "core/scene/scene.h"
#include "tests/support/render_statistics.h"

namespace mote::tests {

using namespace mote::core;

inline constexpr int film_width = 12, film_height = 8;
inline constexpr Vec2 film_size{float(film_width), float(film_height)};

struct CameraCase {
    std::string type, name;
    std::shared_ptr<const Scene> scene;
    float lens_radius = 0.0f;
    const Camera& camera() const { return scene->camera(); }
    Vec3 axis(const Vec3d& local) const { return Vec3(camera().to_world().vector(local)); }
    Vec3 forward() const { return glm::normalize(axis({0, 0, 1})); }
};

inline CameraCase camera_case(const std::string& type, const std::string& name, const std::string& transform,
                              const std::string& more = "", float lens_radius = 0.0f) {
    const std::string xml = fmt::format(
        R"(<scene version="3.0.0"><emitter type="constant"/><sensor type="{}"><transform name="to_world">{}</transform>{}
        <float name="near_clip" value="0.5"/><float name="far_clip" value="20"/>
        <film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/></film></sensor></scene>)",
        type, transform, more, film_width, film_height);
    return {type, name, load_scene_from_string(xml, ".", registry()), lens_radius};
}

inline std::vector<CameraCase> camera_cases() {
    const std::string look = R"(<lookat origin="1, 2, 3" target="-0.5, 0.3, 0" up="0.2, 1, 0"/>)";
    const std::string mirror = R"(<scale x="-1"/>)";
    const auto number = [](const char* name, const char* value) {
        return fmt::format(R"(<float name="{}" value="{}"/>)", name, value);
    };
    const std::string lens = number("aperture_radius", "0.3"), focus = number("focus_distance", "2.5");
    return {
        camera_case("perspective", "perspective", look, number("fov", "40")),
        camera_case("perspective", "perspective_wide_mirrored", mirror + look, number("fov", "110")),
        camera_case("thinlens", "thinlens", look, number("fov", "40") + lens + focus, 0.3f),
        camera_case("thinlens", "thinlens_wide", look, number("fov", "100") + lens + focus, 0.3f),
        camera_case("orthographic", "orthographic", R"(<scale x="1.5" y="2" z="0.7"/>)" + look),
        // x' = x + z/2: rays that meet the picture aslant.
        camera_case("orthographic", "orthographic_sheared",
                    R"(<matrix value="1 0 0.5 0  0 1 0 0  0 0 1 0  0 0 0 1"/>)" + look),
    };
}

}  // namespace mote::tests
