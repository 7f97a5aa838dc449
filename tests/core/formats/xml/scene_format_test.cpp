// The registry's manual pages: complete, true, and written out.
#include "core/formats/xml/scene_format.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "integrators/register_integrators.h"
#include "lights/register_lights.h"
#include "media/register_media.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

const Registry& full_registry() {
    static const Registry registry = [] {
        Registry r;
        register_core(r);
        mote::media::register_media(r);
        mote::lights::register_lights(r);
        mote::integrators::register_integrators(r);
        return r;
    }();
    return registry;
}

/// A scene that holds the example of a manual page where such an object belongs.
std::string scene_around(const Manual& manual) {
    const std::string& e = manual.example;
    const auto in = [](const std::string& open, const std::string& content, const std::string& close) {
        return scene_xml(open + content + close);
    };
    switch (manual.category) {
        case Category::film:
        case Category::sampler:
            return in("<sensor type='perspective'>", e, "</sensor>");
        case Category::rfilter:
            return in("<sensor type='perspective'><film type='hdrfilm'>", e, "</film></sensor>");
        case Category::emitter:
            if (manual.type == "area") return in("<shape type='sphere'>", e, "</shape>");
            return scene_xml("<shape type='sphere'/>" + e);
        default:
            return scene_xml(e);
    }
}

}  // namespace

TEST_CASE("Every type that a scene may hold survives linking", "[scene][registry]") {
    const std::vector<std::pair<Category, std::vector<std::string>>> expected = {
        {Category::bsdf,
         {"conductor", "dielectric", "diffuse", "null", "phong", "plastic", "principled", "principledthin",
          "roughconductor", "roughdielectric", "roughplastic", "thindielectric", "twosided"}},
        {Category::texture, {"bitmap", "checkerboard"}},
        {Category::shape, {"cube", "cylinder", "disk", "obj", "ply", "rectangle", "sphere"}},
        {Category::emitter, {"area", "constant", "directional", "envmap", "point", "spot"}},
        {Category::sensor, {"orthographic", "perspective", "thinlens"}},
        {Category::film, {"hdrfilm"}},
        {Category::rfilter, {"box", "gaussian", "tent"}},
        {Category::sampler, {"independent", "sobol"}},
        {Category::medium, {"heterogeneous", "homogeneous"}},
        {Category::phase, {"hg", "isotropic"}},
        {Category::volume, {"constvolume", "gridvolume", "vdbvolume"}},
        {Category::integrator, {"mote_vpl", "path", "volpath"}}};
    for (const auto& [category, types] : expected)
        for (const std::string& type : types) {
            INFO(category_name(category) << " " << type);
            CHECK(full_registry().find(category, type) != nullptr);
        }
}

TEST_CASE("Manual pages are complete", "[scene][registry]") {
    std::set<std::string> types = {"boolean", "integer", "float",  "string",
                                   "rgb",     "point",   "vector", "transform"};
    for (int c = 0; c < category_count; ++c) types.insert(category_name(Category(c)));
    for (const Manual* manual : full_registry().manuals()) {
        INFO(category_name(manual->category) << " " << manual->type);
        CHECK_FALSE(manual->summary.empty());
        CHECK_FALSE(manual->example.empty());
        std::set<std::string> names;
        for (const Parameter& p : manual->parameters) {
            INFO(p.name << " is a " << p.type);
            CHECK(types.count(p.type) == 1);
            CHECK(names.insert(p.name).second);
            CHECK_FALSE(p.description.empty());
        }
    }
}

TEST_CASE("Every example of a manual page parses", "[scene][registry]") {
    for (const Manual* manual : full_registry().manuals()) {
        INFO(category_name(manual->category) << " " << manual->type << "\n" << manual->example);
        CHECK(contains(manual->example,
                       "<" + category_name(manual->category) + " type=\"" + manual->type + "\""));
        std::string message;
        try {
            load_scene_from_string(scene_around(*manual), ".", full_registry(), {}, "example.xml");
        } catch (const InputError& error) {
            message = error.what();
        }
        // Files named by an example need not exist; that is found out last.
        if (message.find("was not found") == std::string::npos) CHECK(message == "");
    }
}

TEST_CASE("Every value outside of what its row declares is refused where it stands", "[scene][registry]") {
    int refused = 0;
    for (const Manual* manual : full_registry().manuals()) {
        const auto& rows = manual->parameters;
        if (std::any_of(rows.begin(), rows.end(), [](const Parameter& p) { return p.required; })) continue;
        for (const Parameter& p : rows) {
            const auto refuse = [&](const PropertyValue& value, const std::string& why) {
                Properties properties;
                properties.category = manual->category, properties.type = manual->type;
                properties.values[p.name] = {value, {"test.xml", 7}};
                INFO(category_name(manual->category) << " " << manual->type << ": " << p.name);
                CHECK_THROWS_WITH(full_registry().factory(manual->category, manual->type)(properties),
                                  ContainsSubstring("test.xml:7: ") && ContainsSubstring(why));
                ++refused;
            };
            const auto refuse_number = [&](double value) {
                const std::string why = "but " + p.range.demand();
                if (p.range.contains(value)) return;
                if (p.type == "integer")
                    refuse(std::int64_t(value), why);
                else if (p.type == "float")
                    refuse(value, why);
                else
                    refuse(Rgb(float(value)), why);
            };
            if (!p.choices.empty()) refuse(std::string("no such word"), "'" + p.name + "' cannot be");
            if (std::isfinite(p.range.lower))
                refuse_number(p.range.lower), refuse_number(p.range.lower - 2.0);
            if (std::isfinite(p.range.upper))
                refuse_number(p.range.upper), refuse_number(2.0 * std::fabs(p.range.upper) + 2.0);
        }
    }
    CHECK(refused > 150);
}

TEST_CASE("The format page holds every type and parameter", "[scene][registry]") {
    const std::string page = scene_format_markdown(full_registry());
    for (const Manual* manual : full_registry().manuals()) {
        CHECK(contains(page, "### `" + manual->type + "`"));
        for (const Parameter& p : manual->parameters) CHECK(contains(page, "| `" + p.name + "` | " + p.type));
    }
}

TEST_CASE("docs/scene-format.md is what the registry says", "[scene][registry]") {
    std::ifstream file(MOTE_SOURCE_DIR "/docs/scene-format.md");
    std::stringstream text;
    text << file.rdbuf();
    INFO("write the page anew with: mote_tests_core '[write-docs]'");
    const bool same = text.str() == scene_format_markdown(full_registry());
    CHECK(same);
}

TEST_CASE("Write docs/scene-format.md", "[.][write-docs]") {
    std::ofstream file(MOTE_SOURCE_DIR "/docs/scene-format.md");
    file << scene_format_markdown(full_registry());
    CHECK(file.good());
}

TEST_CASE("The scene of the format page loads", "[scene][registry]") {
    const std::string page = scene_format_markdown(full_registry());
    const std::size_t begin = page.find("<scene version"), end = page.find("</scene>");
    REQUIRE(begin != std::string::npos);
    const auto scene =
        load_scene_from_string(page.substr(begin, end + 8 - begin), ".", full_registry(), {}, "page.xml");
    CHECK(scene->film().width == 512);
    CHECK(scene->parts().warnings.empty());
}

TEST_CASE("Categories have names", "[scene][registry]") {
    for (int c = 0; c < category_count; ++c) CHECK(find_category(category_name(Category(c))) == Category(c));
    CHECK_FALSE(find_category("scene").has_value());
    Registry r;
    register_core(r);
    CHECK_THROWS_AS(register_core(r), std::logic_error);
    CHECK_THROWS_AS(r.factory(Category::bsdf, "none"), std::out_of_range);
}
