// pbrt scenes: the same picture as the scene that says the same in our language, orientation, instances,
// lights.
#include <cmath>

#include "core/formats/pictures/image_file.h"
#include "tests/core/formats/pbrt/pbrt_folder.h"
#include "tests/support/render_statistics.h"

using namespace mote::core;
using namespace mote::tests;
using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;

namespace {

RenderStatistics picture(const Scene& scene, std::uint32_t passes) {
    const auto integrator =
        integrator_from("<integrator type='path'><integer name='max_depth' value='4'/></integrator>");
    return render_statistics(scene, *integrator, {.block = 4, .passes = passes});
}
/// The picture's mean is that colour: within four standard errors, which are below 3 % of it.
void check_mean(const Scene& scene, const Rgb& expected) {
    const RenderStatistics r = picture(scene, 64);
    for (int c = 0; c < 3; ++c) {
        const Estimate& e = r.whole[r.layer("beauty")][std::size_t(c)];
        const double error = std::sqrt(e.variance_of_mean);
        CHECK(error < 0.03 * double(expected[c]));
        CHECK_THAT(e.mean, WithinAbs(double(expected[c]), 4.0 * error + 1e-4 * double(expected[c])));
    }
}
/// Mean of a block of 4 x 4 pixels, of one channel.
double block_of(const RenderStatistics& r, int x, int y, int channel) {
    return r.blocks[r.layer("beauty")][std::size_t((y * r.blocks_x + x) * 3 + channel)].mean;
}

/// A box with a red and a green wall, a lamp and a sphere in front of the left one; two of the walls by a
/// transform.
const std::string box = R"(
LookAt 0 1 -3.4  0 1 0  0 1 0
Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" 16 "integer yresolution" 12
PixelFilter "box"
Sampler "zsobol" "integer pixelsamples" 4
Integrator "path" "integer maxdepth" 3
WorldBegin
MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [ .7 .7 .6 ]
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ .6 .1 .1 ]
MakeNamedMaterial "green" "string type" "diffuse" "rgb reflectance" [ .1 .6 .1 ]
NamedMaterial "white"
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" [ -1 2 -1  1 2 -1  1 2 1  -1 2 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 1  1 0 1  -1 2 1  1 2 1 ]
AttributeBegin
  NamedMaterial "red"
  Translate -1 1 0  Rotate 90 0 1 0
  Shape "bilinearmesh" "point3 P" [ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ]
AttributeEnd
AttributeBegin
  NamedMaterial "green"
  ConcatTransform [ 0 0 -1 0  0 1 0 0  1 0 0 0  1 1 0 1 ]
  Shape "bilinearmesh" "point3 P" [ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ]
AttributeEnd
AttributeBegin
  Translate -.4 .35 .2
  Shape "sphere" "float radius" .35
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 6 5 4 ] "float scale" 2
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  ReverseOrientation
  Shape "bilinearmesh" "point3 P" [ -.3 1.99 .3  .3 1.99 .3  -.3 1.99 -.3  .3 1.99 -.3 ]
AttributeEnd
)";

/// The box by hand: the left wall of the picture, at negative x, is to the right of our camera at x = -1.
const std::string box_xml =
    R"(<scene version="3.0.0"><integrator type="path"><integer name="max_depth" value="4"/></integrator>
<sensor type="perspective"><float name="fov" value="40"/><string name="fov_axis" value="smaller"/><float name="near_clip" value="1e-5"/>
  <float name="far_clip" value="1e9"/>
  <transform name="to_world"><scale x="-1"/><translate z="-3.4" y="1"/></transform>
  <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/><rfilter type="box"/></film>
  <sampler type="sobol"><integer name="sample_count" value="4"/></sampler></sensor>
<bsdf type="twosided" id="white"><bsdf type="diffuse"><rgb name="reflectance" value=".7 .7 .6"/></bsdf></bsdf>
<bsdf type="twosided" id="red"><bsdf type="diffuse"><rgb name="reflectance" value=".6 .1 .1"/></bsdf></bsdf>
<bsdf type="twosided" id="green"><bsdf type="diffuse"><rgb name="reflectance" value=".1 .6 .1"/></bsdf></bsdf>
<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/></transform><ref id="white"/></shape>
<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><translate y="2"/></transform><ref id="white"/></shape>
<shape type="rectangle"><transform name="to_world"><translate y="1" z="1"/></transform><ref id="white"/></shape>
<shape type="rectangle"><transform name="to_world"><rotate y="1" angle="90"/><translate x="-1" y="1"/></transform><ref id="red"/></shape>
<shape type="rectangle"><transform name="to_world"><rotate y="1" angle="-90"/><translate x="1" y="1"/></transform><ref id="green"/></shape>
<shape type="sphere"><point name="center" x="-.4" y=".35" z=".2"/><float name="radius" value=".35"/><ref id="white"/></shape>
<shape type="rectangle"><transform name="to_world"><scale value=".3"/><rotate x="1" angle="90"/><translate y="1.99"/></transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf><emitter type="area"><rgb name="radiance" value="12 10 8"/></emitter></shape>
</scene>)";

/// A square of side 2 that faces the camera at z = 0, seen by an orthographic one from z = -2.
std::string square(const std::string& material, const std::string& world = "") {
    return pbrt_world(
        world + material + " Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0  -1 1 0  1 -1 0  1 1 0 ]",
        "LookAt 0 0 -2  0 0 0  0 1 0 Camera \"orthographic\"");
}

}  // namespace

TEST_CASE("A pbrt scene and the same scene in XML have one picture", "[pbrt]") {
    const PbrtFolder folder;
    const auto pbrt = folder.load(box);
    const auto xml = load_scene_from_string(box_xml, ".", mote::tests::registry());
    const RenderStatistics a = picture(*pbrt, 64), b = picture(*xml, 64);
    const ZTest test = same_mean(a, "beauty", b, "beauty");
    INFO(test.report);
    CHECK(test.passed);
    // Not mirrored: the left of the picture is red, the right is green.
    CHECK(block_of(a, 0, 1, 0) > 2.0 * block_of(a, 0, 1, 1));
    CHECK(block_of(a, 3, 1, 1) > 2.0 * block_of(a, 3, 1, 0));
    // Planted: the world mirrored.
    std::string mirrored = box;
    mirrored.insert(0, "Scale -1 1 1\n");
    CHECK(!same_mean(picture(*folder.load(mirrored), 64), "beauty", b, "beauty", OnFailure::nothing).passed);
}

TEST_CASE("pbrt cameras: fov of the shorter axis, screen window, orthographic, lens", "[pbrt]") {
    const PbrtFolder folder;
    const auto xml = [&](const std::string& camera, const std::string& film) {
        return folder.convert(film + camera + "WorldBegin\n").xml;
    };
    const std::string tall = "Film \"rgb\" \"integer xresolution\" 10 \"integer yresolution\" 20\n";
    CHECK(xml("Camera \"perspective\" \"float fov\" 60\n", tall).find("name=\"fov\" value=\"60") !=
          std::string::npos);
    const double half = 2.0 * std::atan(0.5 * std::tan(M_PI / 6.0)) * 180.0 / M_PI;
    CHECK(xml("Camera \"perspective\" \"float fov\" 60 \"float screenwindow\" [-.5 .5 -1 1]\n", tall)
              .find("name=\"fov\" value=\"" + std::to_string(half).substr(0, 7)) != std::string::npos);
    const std::string lens =
        xml("Camera \"perspective\" \"float lensradius\" .1 \"float focaldistance\" 3\n", tall);
    CHECK(lens.find("type=\"thinlens\"") != std::string::npos);
    CHECK(lens.find("name=\"focus_distance\" value=\"3\"") != std::string::npos);
    // The square fills the picture: all of it is as bright as its reflectance.
    check_mean(*folder.load(square("Material \"diffuse\" \"rgb reflectance\" [.2 .4 .6]")),
               Rgb(0.2f, 0.4f, 0.6f));
    CHECK(folder.error("Camera \"spherical\"\nWorldBegin\n") ==
          "scene.pbrt:1: the camera 'spherical' has no counterpart here");
}

TEST_CASE("A camera turned by rounded numbers has no row of perspective", "[pbrt]") {
    const PbrtFolder folder;
    const std::string scene =
        pbrt_world("Shape \"sphere\"",
                   "Transform [ 4.37113e-8 0 -1 -1e-9 0.6 0.8 0 0 -0.8 0.6 3.3e-9 0 0.1 -3.5 28.2792 1 ]\n"
                   "Camera \"perspective\"");
    CHECK(folder.error(scene) == "");
    CHECK(folder.convert(scene).xml.find(" 0 0 0 1\"") != std::string::npos);
}

TEST_CASE("Exposure time and sensitivity are a factor on light", "[pbrt]") {
    const PbrtFolder folder;
    std::string scene = square("Material \"diffuse\"");
    scene.replace(scene.find("\"integer xres"), 0, "\"float iso\" 50 ");
    scene.replace(scene.find("\"orthographic\""), 14, "\"orthographic\" \"float shutterclose\" 0.5");
    check_mean(*folder.load(scene), Rgb(0.125f));
}

TEST_CASE("pbrt lights: scale, power, illuminance", "[pbrt]") {
    const PbrtFolder folder;
    const auto power = [&](const std::string& light) {
        const auto scene = folder.load(pbrt_world("Shape \"sphere\"\n" + light));
        return double(scene->emitters().back()->power().y);
    };
    CHECK_THAT(power("LightSource \"point\" \"rgb I\" [2 3 4] \"float scale\" 5"),
               WithinRel(60.0 * M_PI, 1e-5));
    CHECK_THAT(power("LightSource \"point\" \"float power\" 7"), WithinRel(7.0, 1e-5));
    // Full radiance: pi times area; twice that for both sides.
    const std::string quad = "Shape \"bilinearmesh\" \"point3 P\" [5 0 0 7 0 0 5 2 0 7 2 0]";
    const auto lamp = [&](const std::string& parameters) {
        return power("AreaLightSource \"diffuse\" " + parameters + "\n" + quad);
    };
    CHECK_THAT(lamp("\"rgb L\" [1 2 3]"), WithinRel(2.0 * 4.0 * M_PI, 1e-5));
    CHECK_THAT(lamp("\"float power\" 11"), WithinRel(11.0, 1e-5));
    CHECK_THAT(lamp("\"float power\" 11 \"bool twosided\" true"), WithinRel(5.5, 1e-5));  // of one side
    const auto infinite = [&](const std::string& parameters) {
        return folder.convert("WorldBegin LightSource " + parameters).xml;
    };
    CHECK(infinite("\"infinite\" \"float illuminance\" 3.14159265358979").find("value=\"1, 1, 1\"") !=
          std::string::npos);
    CHECK(infinite("\"distant\" \"float illuminance\" 4 \"point3 from\" [0 9 0] \"point3 to\" [0 0 0]")
              .find("value=\"4, 4, 4\"") != std::string::npos);
    CHECK(infinite("\"distant\" \"point3 from\" [0 9 0] \"point3 to\" [0 0 0]").find("value=\"0, -1, 0\"") !=
          std::string::npos);
}

TEST_CASE("Two-sided lights of pbrt are seen from both sides", "[pbrt]") {
    const PbrtFolder folder;
    for (const std::string camera : {"LookAt 0 0 -2 0 0 0 0 1 0", "LookAt 0 0 2 0 0 0 0 1 0"}) {
        const std::string scene = pbrt_world(
            "AreaLightSource \"diffuse\" \"bool twosided\" true \"rgb L\" [3 3 3] Material \"diffuse\" \"rgb "
            "reflectance\" [0 0 0]"
            "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0  -1 1 0  1 -1 0  1 1 0 ]",
            camera + " Camera \"orthographic\"");
        check_mean(*folder.load(scene), Rgb(3.0f));
    }
}

TEST_CASE("Objects of pbrt are instanced; area lights in them emit nothing", "[pbrt]") {
    const PbrtFolder folder;
    const std::string scene = pbrt_world(R"(
ObjectBegin "pair"
  Translate 0 0 1
  Shape "sphere" "float radius" .5
  AreaLightSource "diffuse"
  Shape "disk"
ObjectEnd
Translate 5 0 0
ObjectInstance "pair"
AttributeBegin Scale -1 2 1 ObjectInstance "pair" AttributeEnd
ObjectBegin "nothing" ObjectEnd
ObjectInstance "nothing")");
    const auto loaded = folder.load(scene);
    CHECK(loaded->emitters().size() == 1);
    const std::string xml = folder.convert(scene).xml;
    CHECK(xml.find("<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 1\" />") !=
          std::string::npos);                                           // in the object
    CHECK(xml.find("<matrix value=\"-1 0 0 5 ") != std::string::npos);  // of the second
    std::size_t count = 0;
    for (std::size_t at = 0; (at = xml.find("\"instance\"", at)) != std::string::npos; ++at) ++count;
    CHECK(count == 2);
    CHECK(folder.error(pbrt_world(
              "Shape \"sphere\" ObjectBegin \"a\" Shape \"sphere\" ObjectEnd ObjectInstance \"aa\"")) ==
          "scene.pbrt:5: there is no object 'aa' (did you mean 'a'?)");
}

TEST_CASE("Transforms of pbrt and named coordinate systems", "[pbrt]") {
    const PbrtFolder folder;
    const auto place = [&](const std::string& directives) {
        const std::string xml = folder.convert(pbrt_world(directives + " Shape \"sphere\"")).xml;
        const std::size_t at = xml.find("matrix", xml.find("type=\"sphere\""));
        return xml.substr(at + 14, xml.find('"', at + 14) - at - 14);
    };
    CHECK(place("Translate 1 2 3 Scale 2 2 2") == "2 0 0 1 0 2 0 2 0 0 2 3 0 0 0 1");
    CHECK(place("Transform [2 0 0 0 0 2 0 0 0 0 2 0 1 2 3 1] Identity") == "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
    CHECK(place("Translate 1 0 0 CoordinateSystem \"here\" Identity Translate 0 9 0 CoordSysTransform "
                "\"here\"") == "1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1");
    CHECK(place("AttributeBegin Translate 1 0 0 AttributeEnd TransformBegin Translate 1 0 0 TransformEnd") ==
          "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
    // The camera's own space: z forward, x to the right.
    const std::string xml =
        folder
            .convert(
                "LookAt 1 2 3  1 2 7  0 1 0 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\"\n"
                "Translate 0 0 1 Shape \"sphere\"")
            .xml;
    CHECK(xml.find("<matrix value=\"1 0 0 1 0 1 0 2 0 0 1 4 0 0 0 1\" />") != std::string::npos);
    CHECK(folder.error(
              pbrt_world("ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Shape \"sphere\"")) ==
          "scene.pbrt:5: shapes that move have no counterpart here");
}

TEST_CASE("Attributes are parameters of what follows", "[pbrt]") {
    const PbrtFolder folder;
    const std::string xml = folder
                                .convert(pbrt_world("Attribute \"shape\" \"float radius\" 3 Shape \"sphere\" "
                                                    "Shape \"sphere\" \"float radius\" 2"))
                                .xml;
    CHECK(xml.find("name=\"radius\" value=\"3\"") != std::string::npos);
    CHECK(xml.find("name=\"radius\" value=\"2\"") != std::string::npos);
}

TEST_CASE("Pictures stand upright: v points up in pbrt", "[pbrt]") {
    const PbrtFolder folder;
    const auto png = encode_png(
        1, 6, std::vector<std::uint8_t>{255, 0, 0, 255, 0, 0, 255, 0, 0, 0, 255, 0, 0, 255, 0, 0, 255, 0},
        true);
    folder.write("two.png", {reinterpret_cast<const char*>(png.data()), png.size()});
    const std::string texture =
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"two.png\" \"string filter\" \"point\"";
    const std::string quad =
        "Material \"diffuse\" \"texture reflectance\" \"s\" Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0  1 "
        "-1 0  -1 1 0  1 1 0 ]";
    for (const std::string s :
         {"Texture \"s\" \"spectrum\" \"scale\" \"texture tex\" \"t\" \"float scale\" 0.5", ""}) {
        std::string scene =
            pbrt_world(texture + "\n" + s + "\n" + quad, "LookAt 0 0 -2 0 0 0 0 1 0 Camera \"orthographic\"");
        if (s.empty()) scene.replace(scene.find("\"s\""), 3, "\"t\"");
        const RenderStatistics r = picture(*folder.load(scene), 64);
        const double full = s.empty() ? 1.0 : 0.5;
        const auto block = [&](int y, int channel) { return block_of(r, 1, y, channel); };
        CHECK(block(0, 0) > 0.9 * full);  // above: red
        CHECK(block(0, 1) < 0.1 * full);  // baked pictures are bilinear
        CHECK(block(2, 1) > 0.9 * full);  // below: green
        CHECK(block(2, 0) < 0.1 * full);
    }
}
