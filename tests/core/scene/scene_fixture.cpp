// Lights, media and integrators for tests of the scene language.
#include "tests/core/scene/scene_fixture.h"

#include "core/geometry/shape.h"

namespace mote::tests {

using namespace core;

std::optional<EmissionSample> FakeEmitter::sample_emission(const Vec2& u, const Vec2&) const {
    EmissionSample s{};
    s.origin = position, s.direction = {0, 0, 1}, s.weight = strength, s.pdf_area = s.pdf_solid_angle = 1.0f;
    if (shape) {
        const ShapeSample on_shape = shape->sample_area(u);
        s.origin = on_shape.position, s.normal = s.direction = on_shape.normal, s.shape = shape;
    }
    return s;
}

MediumTraits FakeMedium::traits() const {
    MediumTraits t;
    t.homogeneous = true, t.emissive = emissive, t.scattering = false;
    t.description = "fake";
    return t;
}

namespace {

struct FakeLight {
    Vec3d position{0.0};
    Rgb strength{1.0f};
};

void add_emitter(Registry& r, const std::string& type, const EmitterTraits& traits,
                 const Rows<FakeLight>& rows) {
    add_type<FakeLight>(r, Category::emitter, type, "", {rows}, "<emitter type='" + type + "'/>",
                        [=](const FakeLight& s) {
                            auto e = std::make_shared<FakeEmitter>();
                            e->kind = traits, e->position = Vec3(s.position), e->strength = s.strength;
                            return e;
                        });
}

void register_fakes(Registry& r) {
    const auto strength = [](const char* name) {
        return row(name, &FakeLight::strength, between(0, 1e30), "");
    };
    add_emitter(r, "point", {EmitterKind::point, true},
                {point_row("position", &FakeLight::position, "", ""), strength("intensity")});
    add_emitter(r, "area", {EmitterKind::area}, strength("radiance"));
    add_emitter(r, "constant", {EmitterKind::environment, false, false, true}, strength("radiance"));
    add_type<FakeMedium>(
        r, Category::medium, "homogeneous", "",
        {row("sigma_t", &FakeMedium::sigma_t, ""), row("emissive", &FakeMedium::emissive, "")},
        "<medium type='homogeneous'/>", [](const FakeMedium& m) { return std::make_shared<FakeMedium>(m); });
    const Factory integrator = [](const Properties& p) {
        auto i = std::make_shared<FakeIntegrator>();
        i->properties = p;
        i->properties.warnings = i->properties.files = nullptr;  // they end with the loading
        return i;
    };
    r.add({Category::integrator,
           "fake",
           "",
           {{"max_depth", "integer", "-1", ""},
            {"bound", "float", "1", ""},
            {"flag", "boolean", "false", ""},
            {"word", "string", "", ""},
            {"colour", "rgb", "0", ""},
            {"centre", "point", "0", ""},
            {"axis", "vector", "0", ""},
            {"to_world", "transform", "", ""},
            {"picture", "texture", "0", ""},
            {"filename", "string", "", ""},
            {"depth_of_things", "integer", "0", ""}},
           "<integrator type='fake'/>"},
          integrator);
    r.add({Category::integrator,
           "other",
           "",
           {{"max_depth", "integer", "-1", ""}},
           "<integrator type='other'/>"},
          integrator);
}

}  // namespace

const Registry& test_registry() {
    static const Registry registry = [] {
        Registry r;
        register_core(r);
        register_fakes(r);
        return r;
    }();
    return registry;
}

std::string scene_xml(const std::string& body, const std::string& version) {
    std::string xml = "<scene version=\"" + version + "\">\n" + body;
    if (body.find("<sensor") == std::string::npos) xml += "\n<sensor type=\"perspective\"/>";
    // A medium around the sensor or a shape may have no end, and nothing comes through it from infinity.
    const auto holds = [&](const char* tag) { return body.find(tag) != std::string::npos; };
    const bool inside = holds("<medium") && (holds("<sensor") || holds("<shape"));
    if (!holds("<emitter")) xml += inside ? "\n<emitter type=\"point\"/>" : "\n<emitter type=\"constant\"/>";
    return xml + "\n</scene>\n";
}

std::unique_ptr<Scene> load(const std::string& xml, const LoadOptions& options) {
    return load_scene_from_string(xml, ".", test_registry(), options, "test.xml");
}

const Properties& integrator_of(const Scene& scene) {
    return dynamic_cast<const FakeIntegrator&>(*scene.integrator()).properties;
}

std::string load_error(const std::string& xml, const LoadOptions& options) {
    try {
        load(xml, options);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string file_error(const std::string& path) {
    try {
        load_scene(path, test_registry());
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace mote::tests
