// The unit of length is the user's: a scene of nanometres and one of a million kilometres give the picture
// that the same scene in metres gives, by every integrator that is registered.
//
// Powers of two change no digit of any number, so that pictures are compared pixel by pixel with one seed.
#include <fmt/format.h>

#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

/// Writes elements with all lengths times `s`.
class Units {
  public:
    explicit Units(double s) : s_(s) {}

    static std::string number(double x) { return fmt::format("{:.17g}", x); }
    std::string shape(const std::string& type, const std::string& transform, const std::string& rest) const {
        return fmt::format(
            R"(<shape type="{}"><transform name="to_world">{}<scale value="{:.17g}"/></transform>{}</shape>)",
            type, transform, s_, rest);
    }
    std::string point_light() const {
        return fmt::format(R"(<emitter type="point"><rgb name="intensity" value="{0:.17g}"/>
            <point name="position" x="{1:.17g}" y="{2:.17g}" z="{3:.17g}"/></emitter>)",
                           s_ * s_, 0.6 * s_, 0.3 * s_, 0.5 * s_);
    }
    std::string spot_light() const {
        return fmt::format(
            R"(<emitter type="spot"><rgb name="intensity" value="{0:.17g}"/><transform name="to_world">
            <lookat origin="{1:.17g}, {2:.17g}, {2:.17g}" target="0, {1:.17g}, 0" up="0, 0, 1"/></transform></emitter>)",
            3.0 * s_ * s_, -0.5 * s_, 0.8 * s_);
    }
    std::string camera(double x, double z) const {
        return fmt::format(R"(<sensor type="perspective"><float name="fov" value="40"/>
            <float name="near_clip" value="{0:.17g}"/><float name="far_clip" value="{1:.17g}"/><transform name="to_world">
            <lookat origin="{2:.17g}, 0, {3:.17g}" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>)",
                           0.01 * s_, 100.0 * s_, x * s_, z * s_);
    }
    std::string room(const std::string& wall) const {
        std::string xml;
        for (const char* turn : {"", R"(<rotate x="1" angle="-90"/>)", R"(<rotate x="1" angle="90"/>)",
                                 R"(<rotate y="1" angle="90"/>)", R"(<rotate y="1" angle="-90"/>)"})
            xml += shape("rectangle", std::string(R"(<translate z="-1"/>)") + turn, wall);
        return xml + shape("cube",
                           R"(<scale value="0.3"/><rotate y="1" angle="25"/>
                           <translate x="0.3" y="-0.7" z="-0.2"/>)",
                           wall);
    }
    std::string lamp() const {
        return shape("rectangle", R"(<scale value="0.25"/><rotate x="1" angle="90"/><translate y="0.95"/>)",
                     R"(<emitter type="area"><rgb name="radiance" value="10, 8, 6"/></emitter>)");
    }
    std::string fog(double g) const {
        return fmt::format(R"(<bsdf type="null"/><medium type="homogeneous" name="interior">
            <float name="scale" value="{:.17g}"/><rgb name="sigma_t" value="0.5, 0.8, 1.2"/>
            <rgb name="albedo" value="0.9, 0.8, 0.7"/><phase type="hg"><float name="g" value="{}"/></phase></medium>)",
                           1.0 / s_, g);
    }
    std::string smoke(const std::string& file) const {
        return fmt::format(R"(<bsdf type="null"/><medium type="heterogeneous" name="interior">
            <float name="scale" value="{:.17g}"/><volume name="sigma_t" type="gridvolume">
            <string name="filename" value="{}"/><transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/>
            <scale value="2"/><scale value="{:.17g}"/></transform></volume><rgb name="albedo" value="0.9, 0.8, 0.7"/></medium>)",
                           5.0 / s_, file, s_);
    }
    /// Two instances of a cube and a ball.
    std::string instances(const std::string& wall) const {
        std::string xml =
            R"(<shape type="shapegroup" id="group"><shape type="cube"><transform name="to_world">
            <scale value="0.2"/></transform>)" +
            wall + R"(</shape><shape type="sphere"><float name="radius" value="0.15"/>
            <point name="center" x="0" y="0.35" z="0"/>)" +
            grey + "</shape></shape>";
        for (const char* place :
             {R"(<rotate y="1" angle="30"/><translate x="-0.4" y="-0.8"/>)",
              R"(<scale x="1" y="2" z="0.7"/><rotate z="1" angle="20"/><translate x="0.4" y="-0.3"/>)"})
            xml += shape("instance", place, R"(<ref id="group"/>)");
        return xml;
    }

  private:
    double s_;
};

const std::string checkered =
    R"(<bsdf type="twosided"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
    <rgb name="color0" value="0.7, 0.2, 0.2"/><rgb name="color1" value="0.2, 0.6, 0.3"/>
    <transform name="to_uv"><scale x="4" y="4"/></transform></texture></bsdf></bsdf>)";

struct ScaledScene {
    const char* name;
    std::string (*xml)(const Units& units, const std::string& grid);
};

const ScaledScene scenes[] = {
    {"surfaces and an area light",
     [](const Units& u, const std::string&) {
         return u.room(grey) + u.lamp() + u.camera(0.0, 3.6) +
                u.shape("sphere", R"(<scale value="0.3"/><translate x="-0.4" y="-0.6"/>)", mixed);
     }},
    {"fog and a spot light",
     [](const Units& u, const std::string&) {
         return u.room(grey) + u.spot_light() + u.camera(0.0, 3.6) +
                u.shape("cube", R"(<scale value="0.9"/>)", u.fog(0.0));
     }},
    {"a grid and two kinds of lights",
     [](const Units& u, const std::string& grid) {
         return u.room(grey) + u.lamp() + u.point_light() + u.camera(0.0, 3.6) +
                u.shape("cube", R"(<scale value="0.9"/>)", u.smoke(grid));
     }},
    {"instances with textures under the sun",
     [](const Units& u, const std::string&) {
         return u.room(checkered) + u.instances(checkered) + u.lamp() + u.camera(0.0, 3.6) +
                R"(<emitter type="directional"><vector name="direction" x="0.3" y="-1" z="-0.9"/></emitter>)";
     }},
    {"a camera in a medium",
     [](const Units& u, const std::string&) {
         return u.room(mixed) + u.lamp() + u.point_light() + u.camera(0.1, 2.2) +
                u.shape("cube", R"(<scale value="2.5"/>)", u.fog(0.5));
     }},
};

constexpr int edge = 8;

/// Every registered integrator, and parts of mote_vpl that compute with lengths of their own.
std::vector<std::string> all_integrators() {
    std::vector<std::string> all;
    for (const std::string& type : registry().types(Category::integrator))
        all.push_back(fmt::format(R"(<integrator type="{}">{}</integrator>)", type, quick_settings(type)));
    all.emplace_back(
        R"(<integrator type="volpath"><string name="guiding" value="on"/><integer name="guiding_passes" value="3"/>
        <integer name="guiding_paths" value="256"/>
        <float name="guiding_leaf_samples" value="200"/></integrator>)");
    for (const char* part : {R"(<compensation name="compensation" type="approximate"/>)",
                             R"(<compensation name="compensation" type="exact"/>)",
                             R"(<visibility name="visibility" type="shadow_map"/>)",
                             R"(<visibility name="visibility" type="imperfect_shadow_map"/>)",
                             R"(<integer name="reflective_shadow_maps" value="6"/>)"})
        all.push_back(fmt::format(
            R"(<integrator type="mote_vpl"><integer name="paths" value="40"/>{}</integrator>)", part));
    return all;
}

/// Means of all layers, or why there are none.
struct Rendered {
    std::vector<std::string> names;
    std::vector<std::vector<Rgb>> layers;
    std::string refused;
};

Rendered rendered(const ScaledScene& made, double s, const std::string& integrator, const std::string& grid) {
    Rendered result;
    try {
        const auto scene =
            scene_from("<scene version=\"3.0.0\">" + made.xml(Units(s), grid) + "</scene>", edge);
        RenderRequest request;
        request.seed = 5, request.stop.passes = 2;
        const Film film = render(*scene, *integrator_from(integrator), request).film;
        result.names.push_back("beauty"), result.layers.push_back(film.beauty());
        for (std::size_t i = 0; i < film.layers().size(); ++i)
            result.names.push_back(film.layers()[i].name), result.layers.push_back(film.mean(i));
    } catch (const InputError& error) {
        result.refused = error.what();
    }
    return result;
}

/// The fraction of pixels that differ by more than `tolerance` of the layer's mean.
double fraction_of_others(const std::vector<Rgb>& a, const std::vector<Rgb>& b, double tolerance) {
    double mean = 0.0, others = 0.0;
    for (const Rgb& pixel : a) mean += double(average(pixel)) / double(a.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        others += double(max_component(glm::abs(a[i] - b[i]))) <= tolerance * mean ? 0.0 : 1.0;  // NaN counts
    return others / double(a.size());
}

}  // namespace

TEST_CASE("no picture of any integrator depends on the unit of length", "[scale]") {
    const TemporaryFolder folder;
    const std::string grid = folder.file("smoke.vol");
    smoke_medium(grid);
    for (const ScaledScene& scene : scenes)
        for (const std::string& integrator : all_integrators()) {
            const Rendered metres = rendered(scene, 1.0, integrator, grid);
            for (const double s : {0x1p-30, 0x1p30}) {
                INFO(scene.name << ", lengths times " << s << ", " << integrator);
                const Rendered other = rendered(scene, s, integrator, grid);
                CHECK(other.refused == metres.refused);
                REQUIRE(other.names == metres.names);
                for (std::size_t i = 0; i < metres.layers.size(); ++i) {
                    INFO(metres.names[i]);
                    // Rounding near 1e-6, and rays that just miss.
                    CHECK(fraction_of_others(metres.layers[i], other.layers[i], 1e-4) <= 0.01);
                }
            }
        }
}

TEST_CASE("scenes that leave single precision are refused", "[scale]") {
    for (const double s : {1e-12, 1e13})
        CHECK(rendered(scenes[0], s, R"(<integrator type="path"/>)", "")
                  .refused.find("another unit of length") != std::string::npos);
}
