// Faults of pbrt scenes: each with its file and line, and nothing but a sentence for damaged files.
#include <zlib.h>

#include "core/formats/xml/faults.h"
#include "tests/core/formats/pbrt/pbrt_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

/// Errors of line 5, where the content begins.
std::string fault(const std::string& content) {
    return PbrtFolder().error(pbrt_world(content + "\nShape \"sphere\""));
}

std::string gzip(const std::string& text) {
    std::string out(text.size() + 1000, '\0');
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data())),
    stream.avail_in = uInt(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data()), stream.avail_out = uInt(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

/// A word of every kind.
const std::string small_scene = R"(LookAt 0 0 -5 0 0 0 0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" 4 "integer yresolution" 3
Sampler "halton" Integrator "volpath" "integer maxdepth" 3 Option "seed" 3
WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [.1 .1 .1]
Texture "t" "spectrum" "checkerboard" "float uscale" 2
Attribute "shape" "float alpha" .5
AttributeBegin
 Material "diffuse" "texture reflectance" "t" # comment
 AreaLightSource "diffuse" "blackbody L" 3000
 Rotate 30 0 1 0
 MediumInterface "fog" ""
 Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
AttributeEnd
ObjectBegin "o" Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0] ObjectEnd
ObjectInstance "o"
Shape "loopsubdiv" "integer levels" 1 "integer indices" [0 1 2] "point3 P" [0 0 0 1 0 0 0 1 0]
)";

}  // namespace

TEST_CASE("Faults of pbrt scenes name their line", "[pbrt]") {
    CHECK(fault("Shpe \"sphere\"") == "scene.pbrt:5: unknown directive 'Shpe' (did you mean 'Shape'?)");
    CHECK(fault("Shape \"sphera\"") == "scene.pbrt:5: unknown shape 'sphera' (did you mean 'sphere'?)");
    CHECK(fault("Shape \"sphere\" \"float radios\" 2") ==
          "scene.pbrt:5: 'sphere' has no parameter 'radios' (did you mean 'radius'?)");
    CHECK(fault("Material \"difuse\"") ==
          "scene.pbrt:5: unknown material 'difuse' (did you mean 'diffuse'?)");
    CHECK(fault("NamedMaterial \"gold\"") == "scene.pbrt:5: there is no material 'gold'");
    CHECK(fault("Texture \"a\" \"float\" \"imagmap\"") ==
          "scene.pbrt:5: unknown texture 'imagmap' (did you mean 'imagemap'?)");
    CHECK(fault("LightSource \"spt\"") == "scene.pbrt:5: unknown light 'spt' (did you mean 'spot'?)");
    CHECK(fault("MakeNamedMedium \"m\" \"string type\" \"clod\"") ==
          "scene.pbrt:5: unknown medium 'clod' (did you mean 'cloud'?)");
    CHECK(fault("MediumInterface \"fog\" \"\"") == "scene.pbrt:5: there is no medium 'fog'");
    CHECK(fault("CoordSysTransform \"word\"") ==
          "scene.pbrt:5: there is no coordinate system 'word' (did you mean 'world'?)");
    CHECK(fault("Attribute \"shap\" \"float a\" 1") ==
          "scene.pbrt:5: Attribute has no target 'shap' (did you mean 'shape'?)");
    CHECK(fault("ColorSpace \"rec202\"") ==
          "scene.pbrt:5: unknown colour space 'rec202' (did you mean 'rec2020'?)");
    CHECK(fault("AttributeEnd") == "scene.pbrt:5: AttributeEnd without AttributeBegin");
    CHECK(fault("ObjectEnd") == "scene.pbrt:5: ObjectEnd without ObjectBegin");
    CHECK(fault("Include \"other.pbrt\"") == "scene.pbrt:5: there is no file 'other.pbrt' beside the scene");
    CHECK(fault("Shape \"plymesh\" \"string filename\" \"a.ply\"") ==
          "scene.pbrt:5: there is no file 'a.ply' beside the scene");
    CHECK(fault("LightSource \"point\" \"spectrum I\" \"stdillum-D66\"") ==
          "scene.pbrt:5: there is no spectrum 'stdillum-D66', and no file of that name (did you mean "
          "'stdillum-D65'?)");
    CHECK(fault("AttributeBegin Material \"hair\" AttributeEnd") == "");  // not used: never converted
    CHECK(fault("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]") ==
          "scene.pbrt:5: an index of the mesh names a vertex that is not there");
    CHECK(fault("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1]") ==
          "scene.pbrt:5: 'P' has 4 numbers, no multiple of 3");
}

TEST_CASE("What breaks the grammar of pbrt is an error with its line", "[pbrt]") {
    CHECK(fault("Translate 1 2") == "scene.pbrt:6: 'Shape' is no number");
    CHECK(fault("Shape \"sphere\" \"float radius\" [ 1 2x ]") == "scene.pbrt:5: '2x' is no number");
    CHECK(fault("Shape \"sphere\" \"float radius\" [ 1e999 ]") == "scene.pbrt:5: '1e999' is no number");
    CHECK(fault("Shape \"sphere\" \"flot radius\" 1") ==
          "scene.pbrt:5: 'flot' is no type of a parameter (did you mean 'float'?)");
    CHECK(fault("Shape \"sphere\" \"radius\" 1") ==
          "scene.pbrt:5: 'radius' is not of the form \"type name\"");
    CHECK(fault("Shape \"sphere") == "scene.pbrt:5: a string does not end");
    CHECK(fault("Identity \"Shape\"") == "scene.pbrt:5: a directive is expected, not the string 'Shape'");
    CHECK(fault("WorldBegin") == "scene.pbrt:5: WorldBegin stands twice");
    CHECK(PbrtFolder().error("Camera \"perspective\"\n") == "scene.pbrt: the scene has no WorldBegin");
}

TEST_CASE("All faults of a pbrt scene are reported, and leniency replaces what is at fault", "[pbrt]") {
    const PbrtFolder folder;
    const std::string scene = pbrt_world(
        "Shape \"sphera\"\nMaterial \"measured\"\nShape \"sphere\"\nShpe \"x\" \"float y\" [1 2]\nShape "
        "\"sphere\"");
    try {
        folder.load(scene);
        FAIL("no error");
    } catch (const SceneErrors& errors) {
        REQUIRE(errors.all().size() == 3);
        CHECK_THAT(errors.all()[1].what(),
                   ContainsSubstring("scene.pbrt:6: the material 'measured' has no counterpart here"));
        CHECK_THAT(errors.all()[2].what(), ContainsSubstring("scene.pbrt:8: unknown directive"));
    }
    CHECK(folder.load(scene, true)->shapes().size() == 2);
}

TEST_CASE("pbrt files include others, import them, and may be packed", "[pbrt]") {
    const PbrtFolder folder;
    folder.write("part.pbrt", "Translate 1 0 0\nShape \"sphere\"\n");
    folder.write("packed.pbrt.gz", gzip("Shape \"sphere\"\nShape \"sphere\"\n"));
    const auto scene =
        folder.convert(pbrt_world("Import \"part.pbrt\"\nInclude \"part.pbrt\"\nInclude \"packed.pbrt.gz\""));
    CHECK(scene.files.size() == 3);
    // An import leaves the transform as it was, an include does not.
    CHECK(scene.xml.find("1 0 0 2 0 1 0 0") == std::string::npos);
    CHECK(folder.load(pbrt_world("Include \"packed.pbrt.gz\""))->shapes().size() == 2);
    folder.write("packed.pbrt.gz", gzip("Shape \"sphere\"\n").substr(0, 20));
    CHECK(folder.error(pbrt_world("Include \"packed.pbrt.gz\"")) ==
          "packed.pbrt.gz: the gzip data is damaged or ends too early");
    folder.write("loop.pbrt", "Include \"loop.pbrt\"");
    CHECK(folder.error(pbrt_world("Include \"loop.pbrt\"")) ==
          "loop.pbrt:1: files include each other more than 32 deep");
}

TEST_CASE("A pbrt scene that ends anywhere is loaded, or refused with a sentence", "[pbrt]") {
    const PbrtFolder folder;
    REQUIRE(folder.convert(small_scene).report.faults.size() == 1);  // a light with holes
    int refused = 0;
    for (std::size_t length = 0; length < small_scene.size(); ++length) {
        try {
            folder.convert(small_scene.substr(0, length));
        } catch (const InputError& error) {
            ++refused;
            CHECK(std::string(error.what()).find("scene.pbrt") != std::string::npos);
        }
    }
    CHECK(refused > int(small_scene.size() / 4));
    // Any byte replaced.
    for (std::size_t at = 0; at < small_scene.size(); ++at)
        for (const char c : {'\0', '"', '[', '9', '-'}) {
            std::string damaged = small_scene;
            damaged[at] = c;
            try {
                folder.convert(damaged);
            } catch (const InputError&) {
            }
        }
}
