// Every kind of mistake in a file: the message names file, line and the nearest known name.
#include "core/objects/error.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

/// The error of a scene whose second line is `body`.
std::string error_of(const std::string& body) { return load_error(scene_xml(body)); }
/// ... and of an integrator whose parameter stands in the third line.
std::string parameter_error(const std::string& element) {
    return error_of("<integrator type='fake'>\n" + element + "</integrator>");
}
std::string transform_error(const std::string& operation) {
    return parameter_error("<transform name='to_world'>" + operation + "</transform>");
}

}  // namespace

TEST_CASE("Malformed XML is refused with its line", "[scene][errors]") {
    CHECK(load_error("<scene version='3.0.0'>\n<shape>\n</scene>") ==
          "test.xml:3: malformed XML: Start-end tags mismatch");
    CHECK(contains(load_error(""), "test.xml:1: malformed XML"));
    CHECK(contains(load_error("hello"), "malformed XML"));
    CHECK(load_error("<shape type='sphere'/>") ==
          "test.xml:1: a scene file starts with <scene>, not <shape>");
    CHECK(contains(load_error("<scene version='3.0.0'/>\n<scene/>"), "test.xml:2: more than one element"));
    CHECK(contains(load_error(std::string("<scene>\n\0</scene>", 17)),
                   "test.xml:2: the file holds a zero byte"));
    CHECK(contains(load_error("\xff\xfe<"), "UTF-16"));
    CHECK(load_error("<scene version='3.x'/>") == "test.xml:1: '3.x' is not a version such as 3.0.0");
    CHECK(error_of("words") == "test.xml:1: text inside <scene>: '\?words\?'");
    CHECK(error_of("<bsdf type='diffuse' type='null'/>") == "test.xml:2: attribute 'type' is given twice");
}

TEST_CASE("Unknown names are refused with the nearest known one", "[scene][errors]") {
    CHECK(error_of("<sensr type='perspective'/>") ==
          "test.xml:2: unknown element <sensr> (did you mean 'sensor'?)");
    CHECK(error_of("<shape type='spere'/>") ==
          "test.xml:2: unknown shape type 'spere' (did you mean 'sphere'?)");
    CHECK(error_of("<shape type='sphere'>\n<float name='radious' value='1'/></shape>") ==
          "test.xml:3: shape 'sphere' has no parameter 'radious' (did you mean 'radius'?)");
    CHECK(error_of("<shape type='sphere' idd='x'/>") ==
          "test.xml:2: <shape> has no attribute 'idd' (did you mean 'id'?)");
    CHECK(error_of("<shape/>") == "test.xml:2: <shape> needs the attribute 'type'");
    CHECK(error_of("<bsdf type='diffuse' id='wood'/><shape type='sphere'>\n<ref id='wod'/></shape>") ==
          "test.xml:3: nothing has the id 'wod' (did you mean 'wood'?)");
    CHECK(error_of("<moode type='final'/>").starts_with("test.xml:2: unknown element <moode>"));
    CHECK(parameter_error("<floot name='bound' value='1'/>") ==
          "test.xml:3: unknown element <floot> (did you mean 'float'?)");
    CHECK(parameter_error("<float value='1'/>") == "test.xml:3: <float> needs the attribute 'name'");
    CHECK(parameter_error("<float name='maxDepth' value='1'/>") ==
          "test.xml:3: integrator 'fake' has no parameter 'maxDepth' (did you mean 'max_depth'?)");
    CHECK(contains(parameter_error("<float name='zzzzzz' value='1'/>"), "(known: max_depth, bound, flag, "));
    CHECK(transform_error("<rotat x='1' angle='3'/>") ==
          "test.xml:3: unknown transformation <rotat> (did you mean 'rotate'?)");
    CHECK(error_of("<sensor type='perspective'>\n<string name='fov_axis' value='smaler'/></sensor>") != "");
}

TEST_CASE("Values that do not fit are refused", "[scene][errors]") {
    CHECK(parameter_error("<integer name='max_depth' value='1.5'/>") ==
          "test.xml:3: '1.5' is not an integer");
    CHECK(parameter_error("<float name='bound' value='1..2'/>") == "test.xml:3: '1..2' is not a number");
    CHECK(parameter_error("<float name='bound' value=''/>") == "test.xml:3: '' is not a number");
    CHECK(parameter_error("<float name='bound' value='nan'/>") == "test.xml:3: 'nan' is not a finite number");
    CHECK(parameter_error("<float name='bound' value='-inf'/>") ==
          "test.xml:3: '-inf' is not a finite number");
    CHECK(parameter_error("<float name='bound' value='1e39'/>") ==
          "test.xml:3: '1e39' is not a finite number");
    CHECK(parameter_error("<float name='bound' value='1e999'/>") == "test.xml:3: '1e999' is not a number");
    CHECK(parameter_error("<boolean name='flag' value='yes'/>") ==
          "test.xml:3: 'yes' is neither true nor false");
    CHECK(parameter_error("<rgb name='colour' value='1 2'/>") ==
          "test.xml:3: an rgb has one or three numbers, not 2");
    CHECK(parameter_error("<point name='centre' x='1' y='2'/>") ==
          "test.xml:3: <point> needs the attribute 'z'");
    CHECK(parameter_error("<point name='centre' value='1 2 3 4'/>") ==
          "test.xml:3: three numbers are needed here, not 4");
    CHECK(parameter_error("<boolean name='bound' value='true'/>") ==
          "test.xml:3: 'bound' of integrator 'fake' is a float, not a boolean");
    CHECK(parameter_error("<rgb name='max_depth' value='1'/>") ==
          "test.xml:3: 'max_depth' of integrator 'fake' is an integer, not an rgb");
    CHECK(parameter_error("<float name='bound' value='1'/>\n<float name='bound' value='2'/>") ==
          "test.xml:4: 'bound' is given twice");
    CHECK(parameter_error("<spectrum name='colour' value='400:1, 300:2'/>") ==
          "test.xml:3: the wavelengths of a spectrum must rise");
    CHECK(parameter_error("<spectrum name='colour' value='400:1, 300'/>") ==
          "test.xml:3: '300' is not of the form wavelength:value");
    CHECK(contains(parameter_error("<spectrum name='colour' filename='a.spd'/>"), "not supported"));
    CHECK(parameter_error("<float name='bound' value='1'><float/></float>") ==
          "test.xml:3: <float> holds no other elements");
}

TEST_CASE("Impossible transforms are refused", "[scene][errors]") {
    CHECK(transform_error("<scale x='0'/>") == "test.xml:3: the transform is singular or not finite");
    CHECK(transform_error("<scale value='1 2'/>") == "test.xml:3: three numbers are needed here, not 2");
    CHECK(transform_error("<rotate angle='3'/>") == "test.xml:3: a rotation needs an axis");
    CHECK(transform_error("<matrix value='1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1'/>") ==
          "test.xml:3: the transform is singular or not finite");
    CHECK(transform_error("<matrix value='1 0 0'/>") == "test.xml:3: a matrix has 16 (or 9) numbers, not 3");
    CHECK(transform_error("<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1'/>") ==
          "test.xml:3: the last row of a matrix must be 0 0 0 1");
    CHECK(transform_error("<lookat origin='1 2 3' target='1 2 3' up='0 1 0'/>") ==
          "test.xml:3: lookat: origin and target are the same");
    CHECK(transform_error("<lookat origin='0 0 0' target='0 5 0' up='0 1 0'/>") ==
          "test.xml:3: lookat: up is parallel to the view");
    CHECK(transform_error("<translate x='nan'/>") == "test.xml:3: 'nan' is not a finite number");
}

TEST_CASE("Objects in the wrong place are refused", "[scene][errors]") {
    CHECK(error_of("<bsdf type='diffuse'>\n<shape type='sphere'/></bsdf>") ==
          "test.xml:3: bsdf 'diffuse' takes no nested shape");
    CHECK(error_of("<bsdf type='diffuse'>\n<texture type='checkerboard'/></bsdf>") ==
          "test.xml:3: a nested texture of bsdf 'diffuse' needs a name (known: reflectance)");
    CHECK(error_of("<bsdf type='diffuse'>\n<texture type='checkerboard' name='reflectanc'/></bsdf>") ==
          "test.xml:3: bsdf 'diffuse' has no texture 'reflectanc' (did you mean 'reflectance'?)");
    CHECK(error_of("<medium type='homogeneous' id='m'/><shape type='sphere'>\n<ref id='m'/></shape>") ==
          "test.xml:3: a medium of a shape is named 'interior' or 'exterior'");
    CHECK(error_of("<emitter type='area'/>") == "test.xml:2: an area light must be nested in a shape");
    CHECK(error_of("<shape type='sphere'>\n<emitter type='point'/></shape>") ==
          "test.xml:3: only area lights belong to shapes");
    CHECK(error_of("<shape type='sphere'><bsdf type='null'/><emitter type='area'/></shape>") ==
          "test.xml:2: an area light needs a surface: its BSDF cannot be null");
    CHECK(error_of("<shape type='sphere'><bsdf type='diffuse'/>\n<bsdf type='diffuse'/></shape>") ==
          "test.xml:3: a shape has one bsdf");
    CHECK(error_of("<float name='x' value='1'/>") ==
          "test.xml:2: <float> belongs into an object, not directly into <scene>");
    CHECK(error_of("<bsdf type='diffuse' id='a'/>\n<bsdf type='null' id='a'/>") ==
          "test.xml:3: id 'a' is taken already by line 2 of test.xml");
    CHECK(error_of("<bsdf type='twosided' id='a'>\n<ref id='a'/></bsdf>") ==
          "test.xml:3: bsdf 'twosided' (id 'a') refers to itself");
    CHECK(error_of("<shape type='sphere'>\n<include filename='x.xml'/></shape>") ==
          "test.xml:3: <include> belongs directly into <scene>");
    CHECK(error_of("<integrator type='fake'/>\n<integrator type='fake'/>") ==
          "test.xml:3: the scene has more than one integrator of type 'fake'");
}

TEST_CASE("Scenes that show nothing are refused", "[scene][errors]") {
    CHECK(load_error("<scene version='3.0.0'><emitter type='constant'/></scene>") ==
          "test.xml: the scene has no sensor");
    CHECK(load_error("<scene version='3.0.0'><sensor type='perspective'/><shape type='sphere'/></scene>") ==
          "test.xml: the scene has no light");
    CHECK(load_error("<scene version='3.0.0'><sensor type='perspective'/><emitter type='point'/></scene>") ==
          "test.xml: there is nothing to see: no shapes, no media, no environment");
    CHECK(contains(error_of("<emitter type='constant'/><emitter type='constant'/>"),
                   "more than one environment"));
    // An emissive medium is a light.
    CHECK(load_error("<scene version='3.0.0'><sensor type='perspective'/><shape type='sphere'>"
                     "<bsdf type='null'/><medium type='homogeneous' name='interior'>"
                     "<boolean name='emissive' value='true'/></medium></shape></scene>") == "");
}

TEST_CASE("Cameras that cannot see are refused", "[scene][errors]") {
    const auto error = [](const std::string& parameters) {
        return error_of("<sensor type='perspective'>\n" + parameters + "</sensor>");
    };
    for (const char* fov : {"0", "180", "-5", "200"})
        CHECK(error("<float name='fov' value='" + std::string(fov) + "'/>") ==
              "test.xml:3: 'fov' is " + std::string(fov) +
                  " but must lie between 0 and 180 degrees, both excluded");
    CHECK(error("<string name='fov_axis' value='smaler'/>") ==
          "test.xml:3: 'fov_axis' cannot be 'smaler' (did you mean 'smaller'?)");
    CHECK(error("<float name='fov' value='40'/>\n<string name='focal_length' value='50mm'/>") ==
          "test.xml:4: give either 'fov' or 'focal_length'");
    CHECK(error("<transform name='to_world'><scale value='2'/></transform>") ==
          "test.xml:3: the transform of a camera must not scale or shear");
    CHECK(error("<transform name='to_world'><scale x='-1'/></transform>") == "");
    CHECK(error("<float name='near_clip' value='0'/>") ==
          "test.xml:3: 'near_clip' is 0 but must be above 0 m");
    CHECK(error("<float name='far_clip' value='0.001'/>") ==
          "test.xml:3: 'far_clip' must be larger than 'near_clip'");
    CHECK(error("<film type='hdrfilm'><integer name='width' value='0'/></film>") ==
          "test.xml:3: 'width' is 0 but must lie between 1 and 65536 pixels");
    CHECK(error("<film type='hdrfilm'><integer name='width' value='65536'/>"
                "<integer name='height' value='65536'/></film>") ==
          "test.xml:3: a film has at most 2^28 pixels");
    CHECK(error("<film type='hdrfilm'><integer name='width' value='1'/>"
                "<integer name='height' value='65535'/></film>") == "");
}

TEST_CASE("Depth is limited", "[scene][errors]") {
    std::string open, close;
    for (int i = 0; i < 100; ++i) open += "<bsdf type='twosided'>", close += "</bsdf>";
    CHECK(contains(error_of(open + close), "nested more than 64 deep"));
    std::string chain = "<bsdf type='twosided' id='b0'><bsdf type='diffuse'/></bsdf>";
    for (int i = 1; i < 100; ++i)
        chain = "<bsdf type='twosided' id='b" + std::to_string(i) + "'><ref id='b" + std::to_string(i - 1) +
                "'/></bsdf>" + chain;
    CHECK(contains(error_of(chain), "nested more than 64 deep"));
    std::string doubling = "<default name='x0' value='0123456789'/>";
    for (int i = 1; i < 40; ++i)
        doubling += "<default name='x" + std::to_string(i) + "' value='$x" + std::to_string(i - 1) + "$x" +
                    std::to_string(i - 1) + "'/>";
    CHECK(contains(error_of(doubling), "longer than 4 MB"));
}

TEST_CASE("Names from files are printed safely", "[scene][errors]") {
    CHECK(printable("a\x1b[31m\nb") == "a?[31m?b");
    CHECK(printable("caf\xc3\xa9 \xff\xc3") == "caf\xc3\xa9 ??");
    CHECK(printable(std::string(500, 'x'), 10) == "xxxxxxxxxx...");
    CHECK(std::string(InputError("two\nlines", {"f\n", 3}).what()) == "f?:3: two?lines");
}

TEST_CASE("Nearest names", "[scene][errors]") {
    const std::vector<std::string> known = {"radius", "center", "to_world", "flip_normals"};
    CHECK(nearest_name("toWorld", known) == "to_world");
    CHECK(nearest_name("raduis", known) == "radius");
    CHECK(nearest_name("centre", known) == "center");
    CHECK(nearest_name("elephant", known) == "");
    CHECK(suggestion("elephant", known) == " (known: radius, center, to_world, flip_normals)");
    CHECK(suggestion("x", {}) == "");
}
