// Every way of writing a value, reference, include or parameter.
#include <filesystem>
#include <fstream>
#include <random>

#include "core/geometry/shape.h"
#include "core/materials/bsdf.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

std::unique_ptr<Scene> with_integrator(const std::string& parameters, const LoadOptions& options = {}) {
    return load_body("<integrator type=\"fake\">" + parameters + "</integrator>", options);
}

struct TemporaryFolder {
    std::filesystem::path path = std::filesystem::temp_directory_path() /
                                 ("mote_scene_test_" + std::to_string(std::random_device()()));
    TemporaryFolder() { std::filesystem::create_directories(path); }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    std::string write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path / name).parent_path());
        std::ofstream(path / name) << text;
        return (path / name).string();
    }
};

}  // namespace

TEST_CASE("Values of every kind are read", "[scene][syntax]") {
    const auto scene = with_integrator(R"(
        <integer name="max_depth" value=" -7 "/><float name="bound" value="+.5e1"/>
        <boolean name="flag" value="true"/><string name="word" value="a &amp; b"/>
        <rgb name="colour" value="0.1, 0.2 0.3"/><point name="centre" x="1" y="-2" z="3e0"/>
        <vector name="axis" value="4,5,6"/><float name="picture" value="0.25"/>)");
    const Properties& p = integrator_of(*scene);
    CHECK(value_of<int>(p, "max_depth") == -7);
    CHECK(value_of<double>(p, "bound") == 5.0);
    CHECK(value_of<bool>(p, "flag"));
    CHECK(value_of<std::string>(p, "word") == "a & b");
    CHECK(value_of<Rgb>(p, "colour") == Rgb(0.1f, 0.2f, 0.3f));
    CHECK(value_of<Vec3d>(p, "centre") == Vec3d(1, -2, 3));
    CHECK(value_of<Vec3d>(p, "axis") == Vec3d(4, 5, 6));
    CHECK(value_of<Rgb>(p, "picture") == Rgb(0.25f));
    CHECK(value_of<double>(p, "missing", 9.0) == 9.0);
    CHECK_THROWS_AS(value_of<bool>(p, "bound"), InputError);
}

TEST_CASE("An rgb of one number is grey", "[scene][syntax]") {
    const auto scene = with_integrator("<rgb name='colour' value='0.7'/>");
    CHECK(value_of<Rgb>(integrator_of(*scene), "colour") == Rgb(0.7f));
}

TEST_CASE("Parameters: default, -D, and the type of an element", "[scene][syntax]") {
    const std::string xml = scene_xml(
        "<default name='type' value='fake'/><default name='n' value='3'/><default name='w' value='x$n'/>"
        "<integrator type='$type'><integer name='max_depth' value='$n'/><string name='word' value='$w-$n'/>"
        "</integrator>");
    CHECK(value_of<int>(integrator_of(*load(xml)), "max_depth") == 3);
    CHECK(value_of<std::string>(integrator_of(*load(xml)), "word") == "x3-3");
    const auto changed = load(xml, {{{"n", "12"}}, ""});
    CHECK(value_of<int>(integrator_of(*changed), "max_depth") == 12);
    CHECK(value_of<std::string>(integrator_of(*changed), "word") == "x12-12");
    CHECK(load_error(xml, {{{"m", "1"}}, ""}) == "-D m: the scene does not use $m (known: n, type, w)");
    CHECK(load_error(xml, {{{"typ", "1"}}, ""}) ==
          "-D typ: the scene does not use $typ (did you mean 'type'?)");
    CHECK(load_error(
              scene_xml("<integrator type='fake'>\n<integer name='max_depth' value='$nn'/></integrator>")) ==
          "test.xml:3: $nn is not defined (with <default> or -D)");
}

TEST_CASE("-D with a path sets a parameter of an element", "[scene][syntax]") {
    const std::string xml = scene_xml(
        "<integrator type='fake'><float name='bound' value='2'/></integrator>"
        "<bsdf type='diffuse' id='wall'/><bsdf type='diffuse' id='floor'/>");
    const auto scene = load(xml, {{{"integrator.bound", "0.5"},
                                   {"fake.max_depth", "9"},
                                   {"integrator.colour", "1 2 3"},
                                   {"film.width", "64"},
                                   {"sensor.film.height", "32"},
                                   {"sensor.fov", "30"},
                                   {"sampler.sample_count", "5"},
                                   {"wall.reflectance", "0.2"},
                                   {"bsdf:2.reflectance", "0.3"},
                                   {"sensor.to_world", "1, 2, 3  1, 2, 4  0, 1, 0"}},
                                  ""});
    CHECK(value_of<double>(integrator_of(*scene), "bound") == 0.5);
    CHECK(value_of<int>(integrator_of(*scene), "max_depth") == 9);
    CHECK(value_of<Rgb>(integrator_of(*scene), "colour") == Rgb(1, 2, 3));
    CHECK(scene->film().width == 64);
    CHECK(scene->film().height == 32);
    CHECK(scene->film().sample_count == 5);
    CHECK(scene->camera().position() == Vec3(1, 2, 3));
    const auto error = [&](const char* path, const char* value) {
        return load_error(xml, {{{path, value}}, ""});
    };
    CHECK(error("integrator.bond", "1") ==
          "-D integrator.bond=1: integrator 'fake' has no parameter 'bond' (did you mean 'bound'?)");
    CHECK(error("integrtor.bound", "1") ==
          "-D integrtor.bound=1: the scene has no element 'integrtor' (did you mean 'integrator'?)");
    CHECK(error("bsdf.reflectance", "1") ==
          "-D bsdf.reflectance=1: 'bsdf' fits 2 elements; give the id of one, or 'bsdf:1' for the first");
    CHECK(error("bsdf:3.reflectance", "1").find("has no element 'bsdf:3'") != std::string::npos);
    CHECK(error("integrator.max_depth", "two") == "-D integrator.max_depth=two: 'two' is not an integer");
    CHECK(error("integrator.to_world", "2") ==
          "-D integrator.to_world=2: 'to_world': expected 16 numbers, a matrix row by row, or 9, the origin, "
          "target and up of a lookat; not 1");
    CHECK(error("film.", "2") != "");
    CHECK(error(".", "2") != "");
}

TEST_CASE("Another integrator keeps the parameters that it has", "[scene][syntax]") {
    const std::string xml = scene_xml(
        "<integrator type='fake'><float name='bound' value='2'/><integer name='max_depth' "
        "value='4'/></integrator>");
    const auto scene = load(xml, {{}, "other"});
    CHECK(integrator_of(*scene).type == "other");
    CHECK(value_of<int>(integrator_of(*scene), "max_depth") == 4);
    CHECK_FALSE(integrator_of(*scene).has("bound"));
    CHECK(integrator_of(*load(scene_xml(""), {{}, "other"})).type == "other");
    CHECK(load_error(xml, {{}, "fakee"}) ==
          "--integrator fakee: unknown integrator type 'fakee' (did you mean 'fake'?)");
}

TEST_CASE("References find earlier and later definitions, and aliases", "[scene][syntax]") {
    const auto scene = load_body(R"(
        <shape type="rectangle"><ref id="late"/></shape>
        <bsdf type="diffuse" id="late"/><alias id="late" as="second"/>
        <shape type="rectangle"><ref id="second"/></shape>
        <shape type="rectangle"><bsdf type="twosided"><ref id="late"/></bsdf></shape>)");
    REQUIRE(scene->shapes().size() == 3);
    CHECK(scene->shapes()[0]->bsdf == scene->shapes()[1]->bsdf);
    CHECK(scene->shapes()[0]->bsdf != scene->shapes()[2]->bsdf);
    CHECK(scene->shapes()[2]->index == 2);
}

TEST_CASE("Includes are relative to their file, nest, and are hashed", "[scene][syntax]") {
    const TemporaryFolder folder;
    folder.write("parts/bsdfs.xml", "<scene version='0.5.0'><include filename='deeper.xml'/></scene>");
    folder.write(
        "parts/deeper.xml",
        "<scene version='3.0.0'><bsdf type='diffuse' id='white'/>\n\n<default name='n' value='5'/></scene>");
    const std::string main = folder.write(
        "main.xml",
        scene_xml("<include filename='parts/bsdfs.xml'/>\n<shape type='rectangle'><ref id='white'/>"
                  "</shape><integrator type='fake'><integer name='max_depth' value='$n'/></integrator>"));
    const auto scene = load_scene(main, test_registry());
    CHECK(value_of<int>(integrator_of(*scene), "max_depth") == 5);
    CHECK(scene->parts().input_files.size() == 3);
    CHECK(scene->parts().file == main);

    const std::string sound =
        "<scene version='3.0.0'><default name='n' value='1'/><bsdf type='diffuse' id='white'/>";
    folder.write("parts/deeper.xml", sound + "\n<include filename='../main.xml'/></scene>");
    CHECK(contains(file_error(main), "deeper.xml:2: "));
    CHECK(contains(file_error(main), "includes itself"));
    folder.write("parts/deeper.xml", sound + "\n\n<bsdf type='difuse'/></scene>");
    CHECK(contains(file_error(main), "deeper.xml:3: unknown bsdf type 'difuse' (did you mean 'diffuse'?)"));
    folder.write("parts/deeper.xml", "");
    CHECK(contains(file_error(main), "deeper.xml:1: malformed XML"));
}

TEST_CASE("Files are looked up beside the file that names them, then in <path>", "[scene][syntax]") {
    const TemporaryFolder folder;
    folder.write("assets/thing.txt", "1");
    folder.write("sub/near.txt", "1");
    folder.write("sub/part.xml",
                 "<scene version='3.0.0'><integrator type='fake'><string name='filename' value='near.txt'/>"
                 "</integrator></scene>");
    const std::string main = folder.write("main.xml", scene_xml("<include filename='sub/part.xml'/>"));
    const auto scene = load_scene(main, test_registry());
    CHECK(std::filesystem::equivalent(integrator_of(*scene).find_file("filename"),
                                      folder.path / "sub/near.txt"));
    const std::string second =
        folder.write("second.xml", scene_xml("<path value='assets'/><integrator type='fake'>"
                                             "<string name='filename' value='thing.txt'/></integrator>"));
    const auto found = load_scene(second, test_registry());
    CHECK(std::filesystem::equivalent(integrator_of(*found).find_file("filename"),
                                      folder.path / "assets/thing.txt"));
    const std::string third = folder.write(
        "third.xml", scene_xml("<shape type='obj'>\n<string name='filename' value='absent.obj'/></shape>"));
    CHECK(contains(file_error(third), "third.xml:3: file 'absent.obj' was not found"));
    CHECK(contains(file_error((folder.path / "none.xml").string()), "none.xml' was not found"));
    CHECK(contains(file_error(folder.path.string()), "is not a file"));
}

TEST_CASE("A byte order mark and comments are no obstacle", "[scene][syntax]") {
    CHECK(load_error("\xef\xbb\xbf<?xml version='1.0'?><!-- c -->" + scene_xml("<!-- x -->")) == "");
}

TEST_CASE("Default BSDFs", "[scene][syntax]") {
    const auto scene = load_body(R"(
        <shape type="sphere"/>
        <shape type="sphere"><emitter type="area"/></shape>
        <shape type="sphere"><medium type="homogeneous" name="interior"/></shape>)");
    const auto albedo = [&](std::size_t i) { return scene->shapes()[i]->bsdf->albedo({}, {0, 0, 1}).x; };
    CHECK(albedo(0) == 0.5f);
    CHECK(albedo(1) == 0.0f);
    CHECK(albedo(2) == 0.5f);
    CHECK(scene->shapes()[1]->emitter.get() == scene->emitters()[0].get());
    CHECK(dynamic_cast<const FakeEmitter&>(*scene->emitters()[0]).shape == scene->shapes()[1].get());
    CHECK(scene->media().size() == 1);
    CHECK_FALSE(scene->shapes()[1]->has_medium_boundary);
    CHECK(scene->shapes()[2]->has_medium_boundary);
}

TEST_CASE("a path on the command line means an element's name before a type of that word",
          "[scene][syntax]") {
    const std::string xml = scene_xml(
        "<shape type='sphere'><bsdf type='twosided'><bsdf type='diffuse' name='front'/>"
        "<bsdf type='roughconductor' name='diffuse'/></bsdf></shape>");
    LoadOptions options;
    options.defines = {{"diffuse.alpha", "0.3"}};
    CHECK(load_error(xml, options) == "");
    options.defines = {{"diffuse.reflectance", "0.3"}};
    CHECK(contains(load_error(xml, options), "reflectance"));
    options.defines = {{"front.reflectance", "0.3"}};
    CHECK(load_error(xml, options) == "");
}
