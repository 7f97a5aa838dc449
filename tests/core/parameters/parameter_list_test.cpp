// Declared parameters: what is read, refused and shown follows from one row each.
#include "core/parameters/add_type.h"

#include "tests/support/catch.h"

using namespace mote::core;

namespace {

enum class Falloff : std::uint8_t { none, linear = 7 };

struct Limits {
    int depth = -1;
    bool hidden = false;
};

struct Fog : Limits {
    float density = 0.1f;
    std::optional<double> height;
    std::uint32_t paths = 256;
    Falloff falloff = Falloff::linear;
    bool exact = true;
    Rgb albedo{0.75f, 0.75f, 0.75f};
    Vec3d position{0.0, 1.5, 0.0};
    Transform to_world;
    std::string grid = "density";
    Limits light{5, true};
    std::shared_ptr<SettingsObject<Limits>> object;
    std::optional<Limits> settings;
    std::vector<Nested<Object>> parts;
};

const ParameterList<Limits>& limits() {
    static const ParameterList<Limits> list{
        row("max_depth", &Limits::depth, at_least(1).or_else(-1, "no limit"), "Longest path in edges."),
        row("hidden", &Limits::hidden, "Not seen.")};
    return list;
}

const ParameterList<Fog>& fog() {
    static const ParameterList<Fog> list{
        row("density", &Fog::density, inside(0, 10, "1/m"), "Extinction at the ground."),
        row("height", &Fog::height, above(0, "m"), "Where it ends.").when_absent("that of the scene"),
        row("paths", &Fog::paths, between(0, 1 << 26), "Light paths."),
        row("falloff", &Fog::falloff, {{"none", Falloff::none}, {"linear", Falloff::linear}}, "With height."),
        row("method", &Fog::exact, {{"exact", true}, {"rough", false}}, "Integrals."),
        row("albedo", &Fog::albedo, between(0, 1), "Of the particles."),
        point_row("position", &Fog::position, "m", "Its middle."),
        row("to_world", &Fog::to_world, "Where it lies."),
        row("grid", &Fog::grid, "Name of a grid.").required(),
        limits(),
        within(&Fog::light, row("light_depth", &Limits::depth, between(1, 9), "Of light.")),
        nested("object", &Fog::object, Category::medium, "none", "An object."),
        nested("settings", &Fog::settings, Category::phase, "isotropic", "Settings."),
        nested("parts", &Fog::parts, Category::shape, "none", "Any number.")};
    return list;
}

Properties with(const std::string& name, PropertyValue value) {
    Properties p;
    p.category = Category::medium, p.type = "fog", p.where = {"test.xml", 2};
    p.values["grid"] = {std::string("smoke"), {"test.xml", 3}};
    p.values[name] = {std::move(value), {"test.xml", 7}};
    return p;
}

std::string error_of(const Properties& properties) {
    try {
        fog().read(properties);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string error_of(const std::string& name, PropertyValue value) {
    return error_of(with(name, std::move(value)));
}

Parameter parameter(const std::string& name) {
    for (const Parameter& p : fog().parameters())
        if (p.name == name) return p;
    throw std::out_of_range(name);
}

}  // namespace

TEST_CASE("Parameters that are not given keep the defaults of the struct", "[parameters]") {
    const Fog fog_settings = fog().read(with("density", 0.5));
    CHECK(fog_settings.density == 0.5f);
    CHECK(fog_settings.grid == "smoke");
    CHECK(fog_settings.paths == 256);
    CHECK(fog_settings.falloff == Falloff::linear);
    CHECK_FALSE(fog_settings.height);
    CHECK(fog_settings.depth == -1);
    CHECK(fog_settings.light.depth == 5);
    CHECK(fog_settings.light.hidden);
    CHECK_FALSE(fog_settings.settings);
}

TEST_CASE("Every kind of value is read into its member and no other", "[parameters]") {
    CHECK(fog().read(with("height", std::int64_t(3))).height == 3.0);
    CHECK(fog().read(with("paths", std::int64_t(1) << 26)).paths == 1u << 26);
    CHECK(fog().read(with("falloff", std::string("none"))).falloff == Falloff::none);
    CHECK_FALSE(fog().read(with("method", std::string("rough"))).exact);
    CHECK(fog().read(with("albedo", 0.25)).albedo == Rgb(0.25f));
    CHECK(fog().read(with("albedo", Rgb(0.1f, 0.2f, 0.3f))).albedo == Rgb(0.1f, 0.2f, 0.3f));
    CHECK(fog().read(with("position", Vec3d(1, 2, 3))).position == Vec3d(1, 2, 3));
    CHECK(fog().read(with("to_world", Transform(glm::dmat4(2.0)))).to_world.matrix == glm::dmat4(2.0));
    const Fog deep = fog().read(with("light_depth", std::int64_t(9)));
    CHECK(deep.light.depth == 9);
    CHECK(deep.depth == -1);
    const Fog base = fog().read(with("max_depth", std::int64_t(4)));
    CHECK(base.depth == 4);
    CHECK(base.light.depth == 5);
    CHECK(fog().read(with("hidden", true)).hidden);
}

TEST_CASE("Numbers outside of their range are refused with the range, file and line", "[parameters]") {
    CHECK(error_of("density", 10.0) ==
          "test.xml:7: 'density' is 10 but must lie between 0 and 10 1/m, both excluded");
    CHECK(error_of("density", std::nextafter(10.0, 0.0)).empty());
    CHECK(error_of("height", 0.0) == "test.xml:7: 'height' is 0 but must be above 0 m");
    CHECK(error_of("paths", std::int64_t(-1)) == "test.xml:7: 'paths' is -1 but must lie between 0 and 2^26");
    CHECK(error_of("max_depth", std::int64_t(0)) ==
          "test.xml:7: 'max_depth' is 0 but must be at least 1, or -1 (no limit)");
    CHECK(error_of("max_depth", std::int64_t(1) << 40) ==
          "test.xml:7: 'max_depth' is 2^40 but must lie between -2147483648 and 2147483647");
    CHECK(error_of("max_depth", std::int64_t(-1)).empty());
    CHECK(error_of("albedo", Rgb(0.5f, 1.5f, 0.5f)) ==
          "test.xml:7: a channel of 'albedo' is 1.5 but must lie between 0 and 1");
    CHECK(error_of("density", std::numeric_limits<double>::quiet_NaN()) ==
          "test.xml:7: 'density' is not a finite number");
    CHECK(error_of("position", Vec3d(0.0, std::numeric_limits<double>::infinity(), 0.0)) ==
          "test.xml:7: 'position' is not finite");
    CHECK(error_of("to_world", Transform(glm::dmat4(0.0))) ==
          "test.xml:7: 'to_world' is singular or not finite");
}

TEST_CASE("Unknown words are refused with the nearest one, and values of another kind", "[parameters]") {
    CHECK(error_of("falloff", std::string("linaer")) ==
          "test.xml:7: 'falloff' cannot be 'linaer' (did you mean 'linear'?)");
    CHECK(error_of("method", true) == "test.xml:7: 'method' must be a string, not a boolean");
    CHECK(error_of("hidden", std::string("true")) == "test.xml:7: 'hidden' must be a boolean, not a string");
    CHECK(error_of("paths", 3.0) == "test.xml:7: 'paths' must be an integer, not a float");
    CHECK(error_of("settings", 3.0).empty());  // the scene loader refuses it: there is no such value
    Properties p = with("hidden", true);
    p.values.erase("grid");
    CHECK(error_of(p) == "test.xml:2: medium 'fog' needs the parameter 'grid'");
}

TEST_CASE("Nested objects are objects, settings, or any number of them", "[parameters]") {
    const auto object = std::make_shared<SettingsObject<Limits>>(Limits{3, true});
    const auto child = [&](const char* name, Category category, int line) {
        return Properties::Child{name, category, object, {"test.xml", line}};
    };
    Properties p = with("hidden", true);
    p.children = {child("object", Category::medium, 4), child("", Category::phase, 5),
                  child("first", Category::shape, 6), child("", Category::shape, 7)};
    const Fog read = fog().read(p);
    CHECK(read.object == object);
    REQUIRE(read.settings);
    CHECK(read.settings->depth == 3);
    REQUIRE(read.parts.size() == 2);
    CHECK(read.parts[0].name == "first");
    CHECK(read.parts[1].where.line == 7);
    p.children.push_back(child("", Category::phase, 8));
    CHECK(error_of(p) == "test.xml:8: more than one nested phase");
    p.children = {{"settings", Category::phase, std::make_shared<SettingsObject<int>>(1), {"test.xml", 9}}};
    CHECK(error_of(p) == "test.xml:9: 'settings' is an object of the wrong kind");
}

TEST_CASE("The manual page follows from rows and defaults", "[parameters]") {
    CHECK(parameter("density").default_value == "0.1");
    CHECK(parameter("density").type == "float");
    CHECK(parameter("density").range.text() == "above 0 to below 10");
    CHECK(parameter("density").range.unit == "1/m");
    CHECK(parameter("height").default_value == "that of the scene");
    CHECK(parameter("falloff").default_value == "linear");
    CHECK(parameter("falloff").choices == std::vector<std::string>{"none", "linear"});
    CHECK(parameter("method").default_value == "exact");
    CHECK(parameter("albedo").default_value == "0.75");
    CHECK(parameter("position").type == "point");
    CHECK(parameter("position").default_value == "0, 1.5, 0");
    CHECK(parameter("to_world").default_value == "identity");
    CHECK(parameter("grid").default_value == "required");
    CHECK(parameter("max_depth").range.text() == "1 or more; -1: no limit");
    CHECK(parameter("light_depth").default_value == "5");
    CHECK(values_text(parameter("density")) == "above 0 to below 10 [1/m]");
    CHECK(values_text(parameter("position")) == "[m]");
    CHECK(values_text(parameter("falloff")) == "none, linear");
    CHECK(values_text(parameter("to_world")).empty());
    CHECK(parameter("settings").type == "phase");
    CHECK(parameter("settings").default_value == "isotropic");
}

TEST_CASE("Lists are cut, and begin with other defaults", "[parameters]") {
    const auto few = limits().without({"hidden"});
    REQUIRE(few.parameters().size() == 1);
    CHECK(few.parameters()[0].name == "max_depth");
    CHECK_THROWS_AS(limits().without({"hiden"}), std::logic_error);
    const ParameterList<Limits> other({8, true}, {limits()});
    CHECK(other.parameters()[0].default_value == "8");
    CHECK(other.read({}).depth == 8);
}

TEST_CASE("A type is registered with its page and its factory", "[parameters]") {
    Registry registry;
    add_type(registry, Category::medium, "fog", "Fog.", limits(), "<medium type='fog'/>");
    int warned = 0;
    add_type(registry, Category::medium, "mist", "Mist.", fog(), "<medium type='mist'/>",
             [&](const Fog& settings, const Properties& p) {
                 warned = int(settings.paths) + p.where.line;
                 return std::make_shared<SettingsObject<Fog>>(settings);
             });
    CHECK(registry.find(Category::medium, "fog")->parameters.size() == 2);
    const auto made = std::dynamic_pointer_cast<SettingsObject<Limits>>(
        registry.factory(Category::medium, "fog")(with("max_depth", std::int64_t(2))));
    REQUIRE(made);
    CHECK(made->settings().depth == 2);
    CHECK(registry.factory(Category::medium, "mist")(with("paths", std::int64_t(40))));
    CHECK(warned == 42);
}

TEST_CASE("Numbers are shown short", "[parameters]") {
    CHECK(short_number(0.02) == "0.02");
    CHECK(short_number(-3) == "-3");
    CHECK(short_number(65536) == "65536");
    CHECK(short_number(131072) == "2^17");
    CHECK(short_number(100000) == "100000");
    CHECK(short_number(1e30) == "1e+30");
    CHECK(short_number(2.0 / 3.0) == "0.666667");
}

TEST_CASE("Ranges say what they take", "[parameters]") {
    CHECK(above(0).up_to(1).text() == "above 0 to 1");
    CHECK(above(0).up_to(1).demand() == "must be above 0 and at most 1");
    CHECK(above(0).up_to(1).contains(1.0));
    CHECK_FALSE(above(0).up_to(1).contains(0.0));
    CHECK_FALSE(inside(-1, 1).contains(1.0));
    CHECK_FALSE(at_least(0).contains(std::numeric_limits<double>::quiet_NaN()));
    CHECK(at_least(0).contains(std::numeric_limits<double>::max()));
    CHECK(any("m").text().empty());
}
