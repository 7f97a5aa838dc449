// Scenes and pictures that tests of epipolar sampling share.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/formats/xml/scene_loader.h"
#include "core/render/render_driver.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

namespace mote::tests {

using namespace mote::core;

inline std::unique_ptr<Scene> sized(std::string xml, int width, int height) {
    const std::string film = fmt::format(R"(<film type="hdrfilm"><integer name="width" value="{}"/>
        <integer name="height" value="{}"/><rfilter type="box"/></film></sensor>)",
                                         width, height);
    return load_scene_from_string(xml.replace(xml.find("</sensor>"), 9, film), ".", registry());
}

struct Picture {
    std::vector<Vec3d> pixels;  ///< of one layer, the mean over passes
    Statistics statistics;
    double mean() const {
        double sum = 0.0;
        for (const Vec3d& p : pixels) sum += (p.x + p.y + p.z) / 3.0;
        return sum / double(pixels.size());
    }
};

inline Picture render(const Scene& scene, const std::string& integrator, std::uint32_t passes = 1,
                      const std::string& layer = "single_scattering") {
    const int w = scene.film().width, h = scene.film().height;
    const auto made = integrator_from(integrator);
    const auto layers = made->layers(scene);
    const auto shown =
        std::find_if(layers.begin(), layers.end(), [&](const Layer& l) { return l.name == layer; });
    REQUIRE(shown != layers.end());
    const auto estimator = made->prepare(scene, {.seed = 11, .width = w, .height = h});
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> never{false};
    Picture picture{std::vector<Vec3d>(std::size_t(w * h), Vec3d(0.0)), {}};
    for (std::uint32_t i = 0; i < passes; ++i) {
        PassImage image(w, h, layers.size());
        REQUIRE(estimator->pass({i, *filter, never}, image));
        for (std::size_t k = 0; k < image.layers(); ++k)
            for (const Rgb& value : image.layer(k)) REQUIRE(is_finite(value));
        for (std::size_t p = 0; p < picture.pixels.size(); ++p)
            picture.pixels[p] += Vec3d(image.layer(std::size_t(shown - layers.begin()))[p]) / double(passes);
    }
    estimator->add_statistics(picture.statistics);
    return picture;
}

/// The mean of |a - b| over the mean of b: 1 for a black picture, whatever b is. Where every pixel is off by
/// at most a fraction of itself, so is the picture.
inline double relative_error(const Picture& a, const Picture& b) {
    double difference = 0.0, all = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            difference += std::abs(a.pixels[i][c] - b.pixels[i][c]), all += b.pixels[i][c];
    REQUIRE(all > 0.0);  // two black pictures would agree
    return difference / all;
}

inline std::string epipolar(int lines, int samples, const std::string& more = "") {
    return fmt::format(R"(<integrator type="mote_epipolar"><integer name="lines" value="{}"/>
        <integer name="samples" value="{}"/>{}</integrator>)",
                       lines, samples, more);
}
/// Lines are refined where light varies by more: a pixel between two samples is off by at most this fraction.
inline std::string tolerance(double share) {
    return fmt::format(R"(<float name="tolerance" value="{}"/>)", share);
}
inline constexpr double usual_tolerance = 0.05;  ///< of mote_epipolar
inline const std::string full = R"(<integrator type="mote_single_scattering"/>)";
/// A block before a wall in fog, and a point light at `light`; the camera stands at (0, 0, 4) and looks along
/// -z.
inline std::string block_in_fog(const Vec3d& light, const std::string& more = "") {
    return fmt::format(R"(<scene version="3.0.0">
        <shape type="rectangle"><transform name="to_world"><scale value="6"/><translate z="-3"/></transform>
            <bsdf type="diffuse"/></shape>
        <shape type="cube"><transform name="to_world"><scale x="0.3" y="0.7" z="0.2"/><translate x="0.4" y="0.2"/>
            </transform><bsdf type="diffuse"/></shape>
        <shape type="cube"><transform name="to_world"><scale x="0.15" y="0.15" z="0.15"/><translate x="-0.6" y="-0.5"
            z="1"/></transform><bsdf type="diffuse"/></shape>{}
        <emitter type="point"><point name="position" x="{}" y="{}" z="{}"/></emitter>
        <sensor type="perspective"><float name="fov" value="50"/><transform name="to_world">
            <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
            <medium type="homogeneous" id="fog"><float name="sigma_t" value="0.1"/></medium></sensor></scene>)",
                       more, light.x, light.y, light.z);
}

}  // namespace mote::tests
