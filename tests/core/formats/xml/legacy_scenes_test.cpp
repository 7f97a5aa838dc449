// Files of version 0.x, parameters without effect, and spectra.
#include "core/formats/spectra/spectral_table.h"
#include "core/formats/xml/spectrum.h"
#include "core/geometry/shape.h"
#include "core/materials/bsdf.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

std::unique_ptr<Scene> load_legacy(const std::string& body) { return load(scene_xml(body, "0.5.0")); }

bool warned(const Scene& scene, const std::string& text) {
    for (const std::string& w : scene.parts().warnings)
        if (w.find(text) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("camelCase of version 0.x is converted, and only there", "[scene][legacy]") {
    const std::string body = R"(<integrator type="fake"><integer name="maxDepth" value="5"/>
        <integer name="depthOfThings" value="6"/><boolean name="strictNormals" value="true"/></integrator>)";
    const auto scene = load_legacy(body);
    CHECK(value_of<int>(integrator_of(*scene), "max_depth") == 5);
    CHECK(value_of<int>(integrator_of(*scene), "depth_of_things") == 6);
    CHECK(warned(*scene, "test.xml:2: 'strict_normals' of integrator 'fake' has no effect here"));
    CHECK(load_error(scene_xml(body)) ==
          "test.xml:2: integrator 'fake' has no parameter 'maxDepth' (did you mean 'max_depth'?) (and 2 more "
          "errors)");
    CHECK(load_error(scene_xml("<integrator type='fake'>\n<integer name='sampleSum' value='1'/></integrator>",
                               "0.5.0"))
              .starts_with("test.xml:3: integrator 'fake' has no parameter 'sample_sum'"));
}

TEST_CASE("A sphere of version 0.x may say how finely it was to be tessellated", "[scene][legacy]") {
    const auto scene = load_legacy("<shape type='sphere'><integer name='subdiv' value='200'/></shape>");
    CHECK(scene->shapes()[0]->area() == Approx(12.566371));
    REQUIRE_FALSE(scene->parts().warnings.empty());
    CHECK(scene->parts().warnings[0].find("'subdiv'") != std::string::npos);
    CHECK_THROWS(
        load(scene_xml("<shape type='sphere'><integer name='subdiv' value='200'/></shape>", "3.0.0")));
}

TEST_CASE("Old spellings", "[scene][legacy]") {
    const auto scene = load_legacy(R"(
        <sensor type="perspective"><string name="fovAxis" value="smaller"/><float name="nearClip" value="2"/>
            <float name="focusDistance" value="3"/><float name="fov" value="40"/>
            <transform name="toWorld"><lookAt origin="0, 0, -5" target="0, 0, 0" up="0, 1, 0"/></transform>
            <sampler type="ldsampler"><integer name="sampleCount" value="4"/></sampler>
            <film type="ldrfilm"><string name="pixelFormat" value="rgb"/><float name="gamma" value="2.2"/>
                <boolean name="banner" value="false"/><integer name="width" value="30"/></film></sensor>
        <shape type="sphere"><bsdf type="dielectric"><float name="intIOR" value="1.5"/></bsdf></shape>
        <shape type="sphere"><medium type="homogeneous" name="interior"/></shape>
        <shape type="rectangle"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
            <float name="uscale" value="4"/><float name="voffset" value="0.5"/></texture></bsdf></shape>)");
    CHECK(scene->camera().sample_ray({15, 288}, {}).t_min == Approx(2));
    CHECK(scene->camera().position().z == Approx(-5));
    CHECK(scene->film().width == 30);
    CHECK(scene->film().sampler == "sobol");
    CHECK(scene->film().sample_count == 4);
    CHECK(scene->shapes()[1]->bsdf->traits().null);
    CHECK(warned(*scene, "sampler 'ldsampler' is replaced by 'sobol'"));
    CHECK(warned(*scene, "film 'ldrfilm' is replaced by 'hdrfilm'"));
    CHECK(warned(*scene, "'pixel_format', 'gamma', 'banner' of film"));
    CHECK(warned(*scene, "'focus_distance' of sensor"));
}

TEST_CASE("What would change the picture is refused, not dropped", "[scene][legacy]") {
    const auto error = [](const std::string& value) {
        return load_error(scene_xml(
            "<bsdf type='dielectric'>\n<float name='extEta' value='" + value + "'/></bsdf>", "0.5.0"));
    };
    CHECK(error("1.5") == "test.xml:3: 'ext_eta' is not supported unless it is 1");
    CHECK(error("1.0") == "");
}

TEST_CASE("Colours as on the web are display values", "[scene][legacy]") {
    // IEC 61966-2-1: ((v + 0.055) / 1.055)^2.4 of 0xb0 / 255, and v / 12.92 of 0x05 / 255.
    const auto scene =
        load_legacy(R"(<integrator type="fake"><rgb name="colour" value="#b00510"/></integrator>)");
    const Rgb colour = value_of<Rgb>(integrator_of(*scene), "colour", Rgb(0.0f));
    CHECK(colour.x == Approx(0.434154).epsilon(1e-5));
    CHECK(colour.y == Approx(5.0 / 255.0 / 12.92).epsilon(1e-5));
    CHECK(colour.z == Approx(0.00518152).epsilon(1e-4));
    const auto srgb = load_legacy(
        R"(<integrator type="fake"><srgb name="colour" value="0.5, 0.0392157, 1"/></integrator>)");
    const Rgb decoded = value_of<Rgb>(integrator_of(*srgb), "colour", Rgb(0.0f));
    CHECK(decoded.x == Approx(0.2140411).epsilon(1e-5));
    CHECK(decoded.z == Approx(1.0));
    for (const char* wrong : {"#b0302", "#b030200", "#b0302g", "#", "b03020"})
        CHECK(contains(load_error(scene_xml("<integrator type='fake'>\n<rgb name='colour' value='" +
                                            std::string(wrong) + "'/></integrator>")),
                       "test.xml:3: '"));
}

TEST_CASE("Matching functions have the known white points", "[scene][spectrum]") {
    // CIE 1931: the equal-energy white is (1/3, 1/3); the fit is good to about 1 %.
    const std::vector<SpectralValue> flat = {{360, 1}, {830, 1}};
    Vec3d sum(0.0);
    for (double w = 360; w <= 830; w += 1) sum += cie_xyz(w);
    CHECK(sum.x / (sum.x + sum.y + sum.z) == Approx(1.0 / 3.0).epsilon(0.01));
    CHECK(sum.y == Approx(106.857).epsilon(0.01));  // the integral of y-bar over wavelength [nm]
    const Rgb white = spectrum_to_rgb(flat, false);
    for (int c = 0; c < 3; ++c) CHECK(white[c] == Approx(1.0).epsilon(1e-5));
    // Illuminant E in linear sRGB, from its chromaticity.
    const Rgb light = spectrum_to_rgb(flat, true);
    CHECK(light.x == Approx(1.2048).epsilon(0.01));
    CHECK(light.y == Approx(0.9483).epsilon(0.01));
    CHECK(light.z == Approx(0.9087).epsilon(0.015));
    CHECK(luminance(light) == Approx(1.0).epsilon(1e-3));
}

TEST_CASE("Tables of wavelengths become colours", "[scene][spectrum]") {
    std::vector<std::string> warnings;
    const Rgb red = parse_spectrum("400:0.04, 590:0.15, 600:0.29, 700:0.64", false, {}, warnings);
    CHECK(red.x > 2.0f * red.y);
    CHECK(warnings.empty());
    const Rgb saturated = parse_spectrum("640:1, 700:1", false, {}, warnings);
    CHECK(saturated.y == 0.0f);
    CHECK(warnings.size() == 1);
    CHECK(parse_spectrum("0.3", false, {}, warnings) == Rgb(0.3f));
    CHECK(warnings.size() == 1);
    CHECK(parse_spectrum("0.3", true, {}, warnings) == Rgb(0.3f));
    CHECK(warnings.size() == 2);
    const Rgb eight = parse_spectrum("400:0.78, 500:0.78, 600:0.78, 700:0.78", false, {}, warnings);
    for (int c = 0; c < 3; ++c) CHECK(eight[c] == Approx(0.78).epsilon(0.005));
    // The light of the published Cornell box is orange.
    const Rgb lamp = parse_spectrum("400:0, 500:8, 600:15.6, 700:18.4", true, {}, warnings);
    CHECK(lamp.x > lamp.y);
    CHECK(lamp.y > lamp.z);
}
