// Materials, textures and media of pbrt scenes as elements, and loaded.
#include "tests/core/formats/pbrt/pbrt_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

std::string xml_of(const std::string& content) {
    return PbrtFolder().convert(pbrt_world(content + " Shape \"sphere\"")).xml;
}

}  // namespace

TEST_CASE("Roughness of pbrt: alpha is its root unless that is off", "[pbrt]") {
    CHECK_THAT(xml_of("Material \"conductor\" \"float roughness\" .25"),
               ContainsSubstring("name=\"alpha\" value=\"0.5\""));
    CHECK_THAT(xml_of("Material \"conductor\" \"float roughness\" .25 \"bool remaproughness\" false"),
               ContainsSubstring("name=\"alpha\" value=\"0.25\""));
    CHECK_THAT(xml_of("Material \"dielectric\" \"float uroughness\" .25 \"float vroughness\" .01"),
               ContainsSubstring("name=\"alpha_u\" value=\"0.5\""));
    CHECK_THAT(xml_of("Material \"conductor\""), ContainsSubstring("type=\"conductor\""));
}

TEST_CASE("Every material of pbrt loads, those without a counterpart with leniency alone", "[pbrt]") {
    const PbrtFolder folder;
    const std::string two =
        "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" "
        "\"conductor\"\n";
    for (const std::string material :
         {"\"diffuse\" \"rgb reflectance\" [.1 .2 .3]",
          "\"coateddiffuse\" \"float roughness\" .1 \"float eta\" 1.4", "\"conductor\"",
          "\"conductor\" \"rgb reflectance\" [.9 .5 .3]", "\"dielectric\" \"spectrum eta\" \"glass-F11\"",
          "\"dielectric\" \"float roughness\" .2", "\"thindielectric\"",
          "\"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .3", "\"interface\""}) {
        CAPTURE(material);
        CHECK(folder.error(pbrt_world(two + "Material " + material + " Shape \"sphere\"")) == "");
    }
    for (const std::string material :
         {"\"coatedconductor\"", "\"diffusetransmission\"", "\"measured\" \"string filename\" \"x.bsdf\"",
          "\"subsurface\" \"string name\" \"Skin1\"", "\"hair\" \"float eumelanin\" .4"}) {
        CAPTURE(material);
        const std::string scene = pbrt_world("Material " + material + " Shape \"sphere\"");
        CHECK_THAT(folder.error(scene), ContainsSubstring("has no counterpart here"));
        CHECK(folder.load(scene, true)->shapes().size() == 1);
    }
}

TEST_CASE("The mean of a reflectance that becomes a metal is exact head on", "[pbrt]") {
    // eta = 1, k = 2 sqrt(r / (1 - r)): reflectance k^2 / (4 + k^2) = r.
    const std::string xml = xml_of("Material \"conductor\" \"rgb reflectance\" [.5 .5 .5]");
    CHECK_THAT(xml, ContainsSubstring("name=\"eta\" value=\"1, 1, 1\""));
    CHECK_THAT(xml, ContainsSubstring("name=\"k\" value=\"2, 2, 2\""));
}

TEST_CASE("Holes, displacement and patterns of pbrt become masks, bumps and pictures", "[pbrt]") {
    const std::string chess = "Texture \"c\" \"float\" \"checkerboard\" \"float uscale\" 4 ";
    CHECK_THAT(xml_of(chess + "Attribute \"shape\" \"texture alpha\" \"c\""),
               ContainsSubstring("type=\"mask\""));
    CHECK_THAT(xml_of("Attribute \"shape\" \"float alpha\" .25"),
               ContainsSubstring("name=\"opacity\" value=\"0.25\""));
    CHECK_THAT(
        xml_of(chess +
               "Texture \"b\" \"float\" \"bilerp\" Material \"diffuse\" \"texture displacement\" \"b\""),
        ContainsSubstring("type=\"bumpmap\""));
    CHECK_THAT(xml_of("Texture \"m\" \"spectrum\" \"mix\" \"rgb tex1\" [0 0 0] \"rgb tex2\" [1 1 1] \"float "
                      "amount\" .25 Material \"diffuse\" \"texture reflectance\" \"m\""),
               ContainsSubstring("name=\"reflectance\" value=\"0.25, 0.25, 0.25\""));
    const PbrtFolder folder;
    CHECK(folder.error(pbrt_world(chess + "Attribute \"shape\" \"texture alpha\" \"c\" Shape \"sphere\"")) ==
          "");
    CHECK_THAT(folder.error(pbrt_world("Texture \"f\" \"float\" \"fbm\" Shape \"sphere\"")),
               ContainsSubstring(":5: a texture of type 'fbm' has no counterpart here"));
}

TEST_CASE("Media of pbrt load: colours, grids, a cloud, presets", "[pbrt]") {
    const PbrtFolder folder;
    const auto medium = [&](const std::string& parameters) {
        return folder.error(
            pbrt_world("MakeNamedMedium \"m\" " + parameters +
                       " MediumInterface \"m\" \"\" Material \"interface\" Shape \"sphere\""));
    };
    CHECK(medium("\"string type\" \"homogeneous\" \"rgb sigma_a\" [.1 .2 .3] \"rgb sigma_s\" [1 2 3] \"float "
                 "g\" .7 \"rgb Le\" [1 0 0]") == "");
    CHECK(medium("\"string type\" \"homogeneous\" \"string preset\" \"Cream\"") == "");
    CHECK(medium("\"string type\" \"homogeneous\" \"string preset\" \"Creme\"") ==
          "scene.pbrt:5: there is no medium 'Creme' among the presets (did you mean 'Cream'?)");
    const std::string grid = "\"integer nx\" 2 \"integer ny\" 1 \"integer nz\" 1 ";
    CHECK(medium("\"string type\" \"uniformgrid\" " + grid +
                 "\"float density\" [1 2] \"rgb sigma_s\" [3 2 1]") == "");
    CHECK(medium("\"string type\" \"uniformgrid\" " + grid +
                 "\"float density\" [1 2] \"float temperature\" [900 2000]") == "");
    CHECK(medium("\"string type\" \"uniformgrid\" " + grid + "\"float density\" [1 2 3]") ==
          "scene.pbrt:5: 'density' has 3 values for 2 voxels");
    CHECK(medium("\"string type\" \"rgbgrid\" " + grid +
                 "\"rgb sigma_a\" [1 1 1 0 0 0] \"rgb sigma_s\" [1 2 3 0 0 0] \"rgb Le\" [1 1 1 2 2 2]") ==
          "");
    CHECK(medium("\"string type\" \"cloud\"") == "");
    CHECK(medium("\"string type\" \"nanovdb\" \"string filename\" \"a.nvdb\"") ==
          "scene.pbrt:5: there is no file 'a.nvdb' beside the scene");
}
