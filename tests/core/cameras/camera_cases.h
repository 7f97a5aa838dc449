// One camera of every kind and attitude, for the tests of importance.
#pragma once

#include <fmt/format.h>

#include "core/formats/xml/scene_loader.h"
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
                              const std::string& more = "", float lens_radius = 0.0f, double scale = 1.0) {
    const std::string xml = fmt::format(
        R"(<scene version="3.0.0"><emitter type="constant"/><sensor type="{}"><transform name="to_world">{}</transform>{}
        <float name="near_clip" value="{}"/><float name="far_clip" value="{}"/>
        <film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/></film></sensor></scene>)",
        type, transform, more, 0.5 * scale, 20.0 * scale, film_width, film_height);
    return {type, name, load_scene_from_string(xml, ".", registry()), lens_radius};
}

/// `scale`: lengths are that many times longer, and the views the same.
inline std::vector<CameraCase> camera_cases(double scale = 1.0) {
    const std::string look = fmt::format(R"(<lookat origin="{}, {}, {}" target="{}, {}, 0" up="0.2, 1, 0"/>)",
                                         scale, 2.0 * scale, 3.0 * scale, -0.5 * scale, 0.3 * scale);
    const std::string mirror = R"(<scale x="-1"/>)";
    const auto number = [](const char* name, double value) {
        return fmt::format(R"(<float name="{}" value="{}"/>)", name, value);
    };
    const std::string lens = number("aperture_radius", 0.3 * scale) + number("focus_distance", 2.5 * scale);
    const float radius = float(0.3 * scale);
    const auto make = [&](const std::string& type, const std::string& name, const std::string& transform,
                          const std::string& more = "", float lens_radius = 0.0f) {
        return camera_case(type, name, transform, more, lens_radius, scale);
    };
    const std::string size =
        fmt::format(R"(<scale x="{}" y="{}" z="{}"/>)", 1.5 * scale, 2.0 * scale, 0.7 * scale);
    // x' = x + z/2: rays that meet the picture aslant.
    const std::string shear =
        fmt::format(R"(<matrix value="{0} 0 {1} 0  0 {0} 0 0  0 0 {0} 0  0 0 0 1"/>)", scale, 0.5 * scale);
    return {
        make("perspective", "perspective", look, number("fov", 40)),
        make("perspective", "perspective_wide_mirrored", mirror + look, number("fov", 110)),
        make("thinlens", "thinlens", look, number("fov", 40) + lens, radius),
        make("thinlens", "thinlens_wide", look, number("fov", 100) + lens, radius),
        make("orthographic", "orthographic", size + look),
        make("orthographic", "orthographic_sheared", shear + look),
    };
}

}  // namespace mote::tests
