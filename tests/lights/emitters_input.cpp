// Lights as the scene language makes them: defaults, choices, and values that are refused with file and line.
#include <cmath>

#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "core/scene/medium.h"
#include "lights/register_lights.h"
#include "tests/lights/emitter_examples.h"
#include "tests/lights/emitter_statistics.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

const SourceLocation line7{"scene.xml", 7};

struct Made {
    std::shared_ptr<Emitter> light;
    std::vector<std::string> warnings;
    std::string error;
};

Made make(const std::string& type, const std::map<std::string, PropertyValue>& values = {},
          const std::vector<Properties::Child>& children = {}) {
    Registry registry;
    mote::lights::register_lights(registry);
    Made made;
    Properties properties;
    properties.category = Category::emitter, properties.type = type, properties.where = {"scene.xml", 6};
    properties.warnings = &made.warnings;
    for (const auto& [name, value] : values) properties.values[name] = {value, line7};
    properties.children = children;
    try {
        made.light =
            std::dynamic_pointer_cast<Emitter>(registry.factory(Category::emitter, type)(properties));
    } catch (const InputError& error) {
        made.error = error.what();
    }
    return made;
}

bool refused_at_line(const Made& made) { return made.error.find("scene.xml:7") != std::string::npos; }

}  // namespace

TEST_CASE("every light has a manual page that its factory follows", "[lights][emitters][input]") {
    Registry registry;
    mote::lights::register_lights(registry);
    const std::vector<std::string> expected{"area",  "constant",  "directional", "envmap",
                                            "point", "projector", "spot"};
    CHECK(registry.types(Category::emitter) == expected);
    for (const auto* manual : registry.manuals()) {
        INFO(manual->type);
        CHECK_FALSE(manual->summary.empty());
        CHECK(manual->example.find("<emitter type=\"" + manual->type + "\">") != std::string::npos);
        for (const auto& parameter : manual->parameters) CHECK_FALSE(parameter.description.empty());
    }
}

TEST_CASE("lights default to what Mitsuba 3 defaults to", "[lights][emitters][input]") {
    const auto at = [](const Made& made, const Vec3& p) {
        const auto s = made.light->sample_direct(p, Vec2(0.5f));
        return s ? s->weight.x : 0.0f;
    };
    CHECK(at(make("point"), Vec3(0, 0, 2)) == Approx(0.25));
    CHECK(at(make("spot"), Vec3(0, 0, 2)) == Approx(0.25));
    const float slope = std::tan(17.5f * pi / 180.0f);
    CHECK(at(make("spot"), Vec3(slope, 0, 1)) == Approx(0.5f / (1.0f + slope * slope)).epsilon(1e-4));
    CHECK(make("directional").light->sample_direct(Vec3(0.0f), Vec2(0.5f))->wi == Vec3(0, 0, -1));
    CHECK(at(make("directional"), Vec3(0.0f)) == 1.0f);
    CHECK(make("constant").light->environment(Vec3(0, 1, 0)) == Rgb(1.0f));
    const auto area = make("area");
    SurfaceHit hit;
    CHECK(area.light->radiance(hit, Vec3(0, 0, 1)) == Rgb(1.0f));
}

TEST_CASE("positions and directions come either way", "[lights][emitters][input]") {
    const auto moved = facing_down({1, 2, 3});
    const auto origin = [](const Made& made) {
        return made.light->sample_emission(Vec2(0.5f), Vec2(0.5f))->origin;
    };
    CHECK(origin(make("point", {{"position", Vec3d(1, 2, 3)}})) == Vec3(1, 2, 3));
    CHECK(origin(make("point", {{"to_world", moved}})) == Vec3(1, 2, 3));
    CHECK(refused_at_line(make("point", {{"position", Vec3d(1, 2, 3)}, {"to_world", moved}})));

    const auto wi = [](const Made& made) { return made.light->sample_direct(Vec3(0.0f), Vec2(0.5f))->wi; };
    CHECK(glm::length(wi(make("directional", {{"direction", Vec3d(0, 0, -5)}})) - Vec3(0, 0, 1)) < 1e-6f);
    CHECK(glm::length(wi(make("directional", {{"to_world", moved}})) - Vec3(0, 0, 1)) < 1e-6f);
    CHECK(refused_at_line(make("directional", {{"direction", Vec3d(1, 2, 3)}, {"to_world", moved}})));
    CHECK(refused_at_line(make("directional", {{"direction", Vec3d(0.0)}})));
}

TEST_CASE("brightness that is negative or not finite is refused at its line", "[lights][emitters][input]") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::pair<const char*, const char*> parameters[] = {
        {"point", "intensity"}, {"spot", "intensity"},       {"directional", "irradiance"},
        {"area", "radiance"},   {"projector", "irradiance"}, {"constant", "radiance"}};
    for (const auto& [type, name] : parameters) {
        INFO(type);
        for (const Rgb& bad : {Rgb(-1, 1, 1), Rgb(1, -1e-6f, 1), Rgb(1, 1, nan), Rgb(infinity), Rgb(2e30f)})
            CHECK(refused_at_line(make(type, {{name, bad}})));
        CHECK(make(type, {{name, 2.0}}).light);
        CHECK(make(type, {{name, Rgb(1e12f)}}).warnings.empty());
        const Made black = make(type, {{name, Rgb(0.0f)}});
        CHECK(black.light);
        CHECK(black.warnings.size() == 1);
        CHECK_FALSE(black.light->sample_emission(Vec2(0.5f), Vec2(0.5f)));
    }
}

TEST_CASE("a projector of scale zero is warned about once", "[lights][emitters][input]") {
    const Made black = make("projector", {{"scale", 0.0}});
    REQUIRE(black.light);
    REQUIRE(black.warnings.size() == 1);
    CHECK(black.warnings[0].find("'scale' is zero") != std::string::npos);
    CHECK_FALSE(black.light->sample_emission(Vec2(0.5f), Vec2(0.5f)));
    CHECK(make("projector").warnings.empty());
}

TEST_CASE("textures of lights are checked", "[lights][emitters][input]") {
    const auto texture = [](float minimum, float maximum) {
        return std::make_shared<FunctionTexture>([](const Vec2&) { return Rgb(0.5f); }, Rgb(0.5f), minimum,
                                                 maximum);
    };
    const auto with = [&](const char* type, const char* name, float minimum, float maximum) {
        return make(type, {}, {{name, Category::texture, texture(minimum, maximum), line7}});
    };
    for (const auto& [type, name] :
         {std::pair{"spot", "texture"}, {"area", "radiance"}, {"projector", "irradiance"}}) {
        INFO(type);
        CHECK(with(type, name, 0.0f, 1.0f).light);
        CHECK_FALSE(with(type, name, -0.1f, 1.0f).light);
        CHECK_FALSE(with(type, name, 0.0f, infinity).light);
        CHECK(with(type, name, 0.0f, 0.0f).warnings.size() == 1);
    }
}

TEST_CASE("spots and environments refuse what keeps no angles", "[lights][emitters][input]") {
    const auto stretched = Transform(glm::scale(glm::dmat4(1.0), Vec3d(1, 2, 1)));
    const auto flat = Transform(glm::scale(glm::dmat4(1.0), Vec3d(1, 0, 1)));
    CHECK(make("spot", {{"to_world", stretched}}).error.find("stretches") != std::string::npos);
    CHECK(make("spot", {{"to_world", flat}}).error.find("singular") != std::string::npos);
    CHECK(make("spot", {{"cutoff_angle", 0.0}}).error.find("cutoff_angle") != std::string::npos);
    CHECK(make("spot", {{"cutoff_angle", 181.0}}).error.find("cutoff_angle") != std::string::npos);
    CHECK(make("spot", {{"cutoff_angle", 20.0}, {"beam_width", 21.0}}).error.find("beam_width") !=
          std::string::npos);
    CHECK_THROWS_AS(mote::lights::make_environment_map({1, 1, {Rgb(1.0f)}}, stretched), InputError);
    CHECK_THROWS_AS(mote::lights::make_point_light({0.0, std::nan(""), 0.0}, Rgb(1.0f)), InputError);
    CHECK(make("envmap").error.find("filename") != std::string::npos);
    CHECK(make("envmap", {{"filename", std::string("missing.exr")}}).error.find("missing.exr") !=
          std::string::npos);
}

TEST_CASE("an area light belongs to exactly one shape", "[lights][emitters][input]") {
    const Made made = make("area");
    CHECK_THROWS_AS(made.light->set_scene_bounds(Vec3(0.0f), 1.0f), InputError);
    CHECK_FALSE(made.light->sample_direct(Vec3(0.0f), Vec2(0.5f)));
    const auto first = make_sphere({0, 0, 0}, 1.0, {}, false),
               second = make_sphere({3, 0, 0}, 1.0, {}, false);
    made.light->set_shape(first.get());
    CHECK_NOTHROW(made.light->set_shape(first.get()));
    CHECK_NOTHROW(made.light->set_scene_bounds(Vec3(0.0f), 1.0f));
    CHECK_THROWS_AS(made.light->set_shape(second.get()), InputError);
}
