// The factories behind the scene language: names, defaults, and what they refuse, with file and line.
#include <set>

#include "core/formats/register_formats.h"
#include "core/materials/register_materials.h"
#include "core/objects/properties.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::tests;
using core::Category;
using core::Properties;
using core::Rgb;
using core::TransportMode;
using core::Vec3;

namespace {

const core::BsdfPoint point{};

struct Made {
    core::Registry registry;
    std::vector<std::string> warnings;
    Made() { core::register_materials(registry), core::register_assets(registry); }

    std::shared_ptr<core::Object> make(Properties p) {
        p.where = {"scene.xml", 7};
        p.warnings = &warnings;
        return registry.factory(p.category, p.type)(p);
    }
    std::shared_ptr<core::Bsdf> bsdf(const std::string& type,
                                     std::map<std::string, core::PropertyValue> values = {},
                                     std::vector<std::shared_ptr<core::Object>> nested = {}) {
        Properties p;
        p.category = Category::bsdf, p.type = type;
        int line = 8;
        for (auto& [name, value] : values) p.values[name] = {value, {"scene.xml", line++}};
        for (auto& object : nested) p.children.push_back({"", Category::bsdf, object, {"scene.xml", line++}});
        auto result = std::dynamic_pointer_cast<core::Bsdf>(make(p));
        REQUIRE(result);
        return result;
    }
    void refused(const std::string& type, std::map<std::string, core::PropertyValue> values,
                 const std::string& words, std::vector<std::shared_ptr<core::Object>> nested = {}) {
        CAPTURE(type, words);
        try {
            bsdf(type, std::move(values), std::move(nested));
            FAIL_CHECK("not refused");
        } catch (const core::InputError& e) {
            const std::string message = e.what();
            CAPTURE(message);
            CHECK(message.find("scene.xml:") == 0);
            CHECK(message.find(words) != std::string::npos);
        }
    }
};

Rgb eval(const core::Bsdf& bsdf) {
    return bsdf.eval(point, direction_at(0.8, 0.2), direction_at(0.7, 3.0), TransportMode::radiance);
}

}  // namespace

TEST_CASE("every type can be made from its defaults", "[materials][factories]") {
    Made made;
    const std::set<std::string> wrapping = {"twosided", "mask", "blendbsdf", "normalmap", "bumpmap"};
    for (const std::string& type : made.registry.types(Category::bsdf)) {
        CAPTURE(type);
        if (wrapping.count(type)) continue;  // they need something to wrap: wrapping_test.cpp
        const auto bsdf = made.bsdf(type);
        const auto s = bsdf->sample(point, {0, 0, 1}, 0.5f, {0.4f, 0.6f}, TransportMode::radiance);
        CHECK(s.has_value());
        const core::Manual* manual = made.registry.find(Category::bsdf, type);
        CHECK(
            (!manual->summary.empty() && manual->example.find("type=\"" + type + "\"") != std::string::npos));
    }
    CHECK(made.registry.types(Category::bsdf).size() == 17);
    CHECK(made.registry.types(Category::texture).size() == 3);
    CHECK(made.warnings.empty());
}

TEST_CASE("defaults are Mitsuba's", "[materials][factories]") {
    Made made;
    CHECK(*made.bsdf("diffuse")->diffuse_reflectance(point, {0, 0, 1}) == Rgb(0.5f));
    CHECK(made.bsdf("conductor")->albedo(point, {0, 0, 1}) == Rgb(1.0f));
    CHECK(eval(*made.bsdf("roughconductor")) == eval(*core::make_rough_conductor({}, beckmann(0.1f))));
    const Vec3 steep = direction_at(0.3, 0.0);
    CHECK(made.bsdf("dielectric")->sample(point, steep, 0.9f, {}, TransportMode::radiance)->eta ==
          Approx(1.5046f / 1.000277f));
    CHECK(eval(*made.bsdf("plastic")) == eval(*core::make_plastic({})));
    CHECK(eval(*made.bsdf("roughplastic")) == eval(*core::make_rough_plastic({}, beckmann(0.1f))));
    CHECK(eval(*made.bsdf("phong")) == eval(*core::make_phong({})));
}

TEST_CASE("parameters reach the BSDFs", "[materials][factories]") {
    Made made;
    CHECK(*made.bsdf("diffuse", {{"reflectance", Rgb(0.1f, 0.2f, 0.3f)}})
               ->diffuse_reflectance(point, {0, 0, 1}) == Rgb(0.1f, 0.2f, 0.3f));
    CHECK(made.bsdf("conductor", {{"material", std::string("Au")}})->albedo(point, {0, 0, 1}) ==
          core::make_conductor(gold())->albedo(point, {0, 0, 1}));
    CHECK(eval(*made.bsdf("roughconductor",
                          {{"alpha_u", 0.2}, {"alpha_v", 0.4}, {"distribution", std::string("ggx")}})) ==
          eval(*core::make_rough_conductor({}, core::Microfacet(core::MicrofacetKind::ggx, 0.2f, 0.4f))));
    const auto water = made.bsdf("dielectric", {{"int_ior", std::string("Water")}, {"ext_ior", 1.0}});
    CHECK(water->sample(point, {0, 0, 1}, 0.9f, {}, TransportMode::radiance)->eta == Approx(1.333f));
    const Rgb base(0.8f, 0.5f, 0.1f);
    const core::PlasticParameters nonlinear{1.49f, 1.000277f, core::make_constant_texture(base), grey(1.0f),
                                            true};
    CHECK(eval(*made.bsdf("plastic", {{"nonlinear", true}, {"diffuse_reflectance", base}})) ==
          eval(*core::make_plastic(nonlinear)));
    core::PlasticParameters conserving = nonlinear;
    conserving.conserve_energy = true;
    const auto rough = made.bsdf(
        "roughplastic",
        {{"nonlinear", true}, {"diffuse_reflectance", base}, {"conserve_energy", true}, {"alpha", 0.4}});
    CHECK(eval(*rough) == eval(*core::make_rough_plastic(conserving, beckmann(0.4f))));
    CHECK(eval(*rough) != eval(*core::make_rough_plastic(nonlinear, beckmann(0.4f))));
}

TEST_CASE("bad values are refused with file and line", "[materials][factories]") {
    Made made;
    const double nan = std::nan("");
    made.refused("diffuse", {{"reflectance", Rgb(0.5f, 1.5f, 0.5f)}}, "reflectance");
    made.refused("diffuse", {{"reflectance", -0.1}}, "reflectance");
    made.refused("diffuse", {{"reflectance", nan}}, "finite");
    made.refused("conductor", {{"material", std::string("Cuu")}}, "Cu");
    made.refused("conductor", {{"material", std::string("Cu")}, {"eta", Rgb(1.0f)}}, "not both");
    made.refused("conductor", {{"eta", Rgb(-1.0f)}}, "eta");
    made.refused("roughconductor", {{"alpha", -0.1}}, "alpha");
    made.refused("roughconductor", {{"alpha", nan}}, "finite");
    made.refused("roughconductor", {{"alpha_u", 0.1}}, "together");
    made.refused("roughconductor", {{"alpha_u", 0.1}, {"alpha_v", 0.1}, {"alpha", 0.1}}, "either");
    made.refused("roughconductor", {{"distribution", std::string("phong")}}, "distribution");
    made.refused("dielectric", {{"int_ior", std::string("wather")}}, "water");
    made.refused("dielectric", {{"int_ior", 0.0}}, "int_ior");
    made.refused("dielectric", {{"int_ior", nan}}, "finite");
    made.refused("dielectric", {{"specular_transmittance", 1.2}}, "specular_transmittance");
    made.refused("roughdielectric", {{"int_ior", 1.3}, {"ext_ior", 1.3}}, "differ");
    made.refused("plastic", {{"nonlinear", 1.0}}, "nonlinear");
    made.refused("phong", {{"exponent", -1.0}}, "exponent");
    made.refused("twosided", {}, "needs a nested BSDF");
    made.refused("twosided", {}, "transmits", {core::make_dielectric({})});
    const auto d = core::make_diffuse();
    made.refused("twosided", {}, "not more", {d, d, d});
}

TEST_CASE("principled materials from a scene file", "[materials][factories]") {
    Made made;
    CHECK(eval(*made.bsdf("principled")) == eval(*core::make_principled({})));
    CHECK(eval(*made.bsdf("principledthin")) == eval(*core::make_principled_thin({})));
    // specular 0.5 is an index of 1.5; 0 is one that refracts nothing, but where there is glass.
    CHECK(eval(*made.bsdf("principled", {{"specular", 0.5}})) ==
          eval(*made.bsdf("principled", {{"eta", 1.5}})));
    const auto refracted = [&](std::map<std::string, core::PropertyValue> values) {
        values["spec_trans"] = 1.0, values["roughness"] = 0.0;
        const auto s = made.bsdf("principled", values)
                           ->sample(point, {0, 0, 1}, 0.5f, {0.4f, 0.6f}, TransportMode::power);
        REQUIRE((s && s->transmitted));
        return s->eta;
    };
    CHECK(refracted({{"specular", 0.0}}) == Approx(2.0 / (1.0 - std::sqrt(0.08e-3)) - 1.0));
    CHECK(refracted({{"eta", 1.0}}) == Approx(1.001));
    CHECK(refracted({{"specular", 1.0}}) == Approx(2.0 / (1.0 - std::sqrt(0.08)) - 1.0));
    CHECK(made.bsdf("principled", {{"spec_trans", 0.1}})->traits().transmissive);
    CHECK_FALSE(made.bsdf("principled", {{"spec_trans", 0.0}})->traits().transmissive);
    CHECK(made.bsdf("principledthin", {{"diff_trans", 2.0}})->traits().transmissive);

    made.refused("principled", {{"eta", 1.3}, {"specular", 0.4}}, "either 'eta' or 'specular'");
    for (const char* type : {"principled", "principledthin"})
        for (const char* name :
             {"roughness", "anisotropic", "spec_trans", "spec_tint", "sheen", "sheen_tint", "flatness"}) {
            made.refused(type, {{name, 1.1}}, name);
            made.refused(type, {{name, -0.1}}, name);
        }
    for (const char* name : {"metallic", "clearcoat", "clearcoat_gloss", "specular"})
        made.refused("principled", {{name, 1.1}}, name);
    made.refused("principled", {{"base_color", Rgb(0.5f, 1.2f, 0.5f)}}, "base_color");
    made.refused("principled", {{"eta", -1.5}}, "eta");
    made.refused("principled", {{"main_specular_sampling_rate", -1.0}}, "main_specular_sampling_rate");
    made.refused("principledthin", {{"diff_trans", 2.1}}, "diff_trans");
    made.refused("principledthin", {{"eta", 0.0}}, "eta");
}

TEST_CASE("a roughness may be a texture, where Mitsuba has one", "[materials][factories]") {
    Made made;
    const auto with = [&](const std::string& type, std::vector<std::string> names, float a, float b) {
        Properties p;
        p.category = Category::bsdf, p.type = type;
        for (const std::string& name : names)
            p.children.push_back({name, Category::texture, board(a, b), {"scene.xml", 9}});
        return std::dynamic_pointer_cast<core::Bsdf>(made.make(p));
    };
    // The numbers of a checkerboard lie the other way round than its colours (Mitsuba 3.9).
    const core::BsdfPoint even{{0.1f, 0.1f}}, odd{{0.6f, 0.1f}};
    const Vec3 wo = direction_at(0.8, 0.2), wi = direction_at(0.7, 3.0);
    for (const std::string type : {"roughconductor", "roughdielectric"}) {
        CAPTURE(type);
        const auto bsdf = with(type, {"alpha"}, 0.2f, 0.4f);
        const auto at = [&](float alpha) {
            return made.bsdf(type, {{"alpha", double(alpha)}})->eval(point, wo, wi, TransportMode::radiance);
        };
        CHECK(bsdf->eval(even, wo, wi, TransportMode::radiance) == at(0.4f));
        CHECK(bsdf->eval(odd, wo, wi, TransportMode::radiance) == at(0.2f));
        CHECK((bsdf->traits().textured && !bsdf->traits().anisotropic));
        const auto stretched = with(type, {"alpha_u", "alpha_v"}, 0.2f, 0.4f);
        CHECK((stretched->traits().textured && stretched->traits().anisotropic));
        for (const auto& [a, b] : {std::pair{0.1f, 10.5f}, {-0.1f, 0.1f}})
            CHECK_THROWS_WITH(with(type, {"alpha"}, a, b), ContainsSubstring("'alpha' has values from") &&
                                                               ContainsSubstring("between 0 and 10"));
        CHECK_THROWS_WITH(with(type, {"alpha_u"}, 0.1f, 0.2f), ContainsSubstring("together"));
        CHECK_THROWS_WITH(with(type, {"alpha", "alpha_u", "alpha_v"}, 0.1f, 0.2f),
                          ContainsSubstring("either"));
        CHECK(made.warnings.empty());
        with(type, {"alpha"}, 0.0f, 0.2f);
        CHECK(made.warnings.size() == 1);
        made.warnings.clear();
    }
}

TEST_CASE("textures that leave [0, 1] are refused as reflectances", "[materials][factories]") {
    Made made;
    for (const float bad : {1.01f, -0.01f}) {
        Properties p;
        p.category = Category::bsdf, p.type = "diffuse";
        const auto texture = core::make_bitmap_texture({2, 1, {Rgb(0.5f), Rgb(bad)}});
        p.children.push_back({"reflectance", Category::texture, texture, {"scene.xml", 9}});
        try {
            made.make(p);
            FAIL_CHECK("not refused");
        } catch (const core::InputError& e) {
            CHECK(std::string(e.what()).find("scene.xml:9: ") == 0);
        }
    }
}

TEST_CASE("a textured BSDF looks its texture up where the point is", "[materials][factories]") {
    const auto board = core::make_checkerboard_texture(core::make_constant_texture(Rgb(0.8f)),
                                                       core::make_constant_texture(Rgb(0.1f)));
    const auto diffuse = core::make_diffuse(board);
    CHECK(diffuse->traits().textured);
    CHECK(diffuse->diffuse_reflectance({{0.1f, 0.1f}}, {0, 0, 1})->x == 0.8f);
    CHECK(diffuse->diffuse_reflectance({{0.6f, 0.1f}}, {0, 0, 1})->x == 0.1f);
}

TEST_CASE("what is changed silently elsewhere is said here", "[materials][factories]") {
    Made made;
    made.bsdf("roughconductor", {{"alpha", 1e-6}});
    made.bsdf("phong", {{"diffuse_reflectance", 0.9}, {"specular_reflectance", 0.9}});
    CHECK(made.warnings.size() == 2);
    const auto bright = core::make_phong({10.0f, grey(0.9f), grey(0.9f)});
    CHECK(bright->albedo(point, {0, 0, 1}).x == Approx(1.0f));
}

TEST_CASE("nesting on both sides does not cost twice a level", "[materials][factories]") {
    core::BsdfPtr bsdf = core::make_diffuse(grey(0.5f));
    for (int i = 0; i < 60; ++i) bsdf = core::make_twosided(bsdf);
    CHECK(bsdf->traits().diffuse);
    CHECK(eval(*bsdf).x == Approx(0.5f / core::pi));
}
