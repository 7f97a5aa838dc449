// Denoised pictures: beside what was measured, never in its place. With a stand-in for OpenImageDenoise
// (tests/stand_ins), whose results are known, and with the library itself where there is one.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using mote::core::ImageChannels;
using mote::core::Rgb;

namespace {

const std::string stand_in = MOTE_BINARY_DIR "/stand_ins";

/// A lamp that is seen, and a wall in fog: every layer has light.
struct Folder : TemporaryFolder {
    Folder() {
        write_file(file("scene.xml"), R"(<scene version="3.0.0">
            <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="40"/>
            <integer name="height" value="30"/><rfilter type="box"/></film><transform name="to_world">
            <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
            <medium type="homogeneous"><float name="sigma_t" value="0.1"/><float name="albedo" value="0.8"/></medium></sensor>
            <shape type="rectangle"><transform name="to_world"><scale value="2"/><translate z="-1"/></transform>
                <bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.5, 0.4"/></bsdf></shape>
            <shape type="sphere"><float name="radius" value="0.4"/><point name="center" x="-0.6" y="-0.4" z="0"/>
                <bsdf type="diffuse"/></shape>
            <shape type="rectangle"><transform name="to_world"><scale value="0.3"/><rotate x="1" angle="60"/>
                <translate y="0.9" z="-0.3"/></transform><emitter type="area">
                <rgb name="radiance" value="9, 8, 6"/></emitter></shape>
            </scene>)");
    }
    RunResult run(const std::vector<std::string>& arguments, const std::string& library = stand_in,
                  const std::string& fails = "") const {
        return run_mote(*this, arguments, [&] {
            if (library.empty())
                ::unsetenv("MOTE_OIDN");
            else
                ::setenv("MOTE_OIDN", library.c_str(), 1);
            if (!fails.empty()) ::setenv("MOTE_STAND_IN_FAILS", fails.c_str(), 1);
        });
    }
    RunResult render(const std::string& output, const std::vector<std::string>& more,
                     const std::string& library = stand_in, const std::string& fails = "") const {
        std::vector<std::string> all = {"render", "scene.xml", "--integrator", "volpath", "--passes", "8",
                                        "-t",     "1",         "-o",           output};
        all.insert(all.end(), more.begin(), more.end());
        return run(all, library, fails);
    }
    ImageChannels read(const std::string& name) const { return mote::core::read_exr(file(name)); }
    bool has(const std::string& name) const { return std::filesystem::exists(file(name)); }
};

const std::vector<std::string> noisy{"direct", "indirect", "single_scattering", "multiple_scattering"};

/// Emission, and the noisy layers times `factor`.
void check_denoised(const ImageChannels& image, float factor) {
    std::vector<Rgb> expected = image.rgb("emission");
    for (const std::string& layer : noisy) {
        const std::vector<Rgb> pixels = image.rgb(layer);
        REQUIRE(pixels.size() == expected.size());
        bool any = false;
        for (std::size_t i = 0; i < pixels.size(); ++i)
            expected[i] += factor * pixels[i], any = any || pixels[i] != Rgb(0.0f);
        CHECK(any);
    }
    const std::vector<Rgb> denoised = image.rgb("denoised");
    REQUIRE(denoised.size() == expected.size());
    float most = 0.0f;  // sums of five floats in another order
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (int c = 0; c < 3; ++c)
            most = std::fmax(most, std::fabs(denoised[i][c] - expected[i][c]) / (1e-6f + expected[i][c]));
    CHECK(most < 1e-5f);
}

}  // namespace

TEST_CASE("--denoise adds a layer and leaves all others as they were measured", "[command][denoise]") {
    const Folder folder;
    REQUIRE(folder.render("plain.exr", {}).exit_code == 0);
    const RunResult r = folder.render("a.exr", {"--denoise", "--stats", folder.file("a.json")});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    CHECK(nlohmann::json::parse(read_file(folder.file("a.json")))["seconds"]["denoise"].get<double>() > 0.0);
    const ImageChannels plain = folder.read("plain.exr"), image = folder.read("a.exr");
    for (const std::string& name : plain.names) {
        CAPTURE(name);
        REQUIRE(image.find(name));
        CHECK((*image.find(name) == *plain.find(name)));
    }
    check_denoised(image, 2.0f);
    const std::string said = image.metadata.at("denoised");
    CHECK(said.find("OpenImageDenoise 9.8.7: direct, indirect, ") != std::string::npos);
    CHECK(said.find("with Albedo and Ns") != std::string::npos);
    CHECK(plain.metadata.count("denoised") == 0);
    // The preview shows it, and says so.
    CHECK(read_file(folder.file("a.png")) != read_file(folder.file("plain.png")));
    CHECK(read_file(folder.file("a.png")).find("Denoised") != std::string::npos);
    CHECK(read_file(folder.file("plain.png")).find("Denoised") == std::string::npos);
}

TEST_CASE("mote denoise works on pictures with and without features, and once", "[command][denoise]") {
    const Folder folder;
    REQUIRE(folder.render("plain.exr", {}).exit_code == 0);
    REQUIRE(folder.render("features.exr", {"--auxiliary"}).exit_code == 0);
    const std::string before = read_file(folder.file("plain.exr"));
    const RunResult r = folder.run({"denoise", "plain.exr"});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    CHECK(folder.has("plain_denoised.png"));
    CHECK(read_file(folder.file("plain.exr")) == before);
    const ImageChannels image = folder.read("plain_denoised.exr");
    check_denoised(image, 3.0f);
    CHECK((image.rgb("") == folder.read("plain.exr").rgb("")));
    CHECK(image.metadata.at("denoised").find("without features") != std::string::npos);
    CHECK(image.metadata.at("sceneHash") == folder.read("plain.exr").metadata.at("sceneHash"));

    REQUIRE(folder.run({"denoise", "features.exr", "-o", "b.exr", "--half"}).exit_code == 0);
    CHECK(folder.read("b.exr").metadata.at("denoised").find("with Albedo and Ns") != std::string::npos);
    const RunResult again = folder.run({"denoise", "b.exr", "-o", "c.exr"});
    CHECK(again.exit_code == 1);
    CHECK(again.err.find("b.exr: it is denoised already") != std::string::npos);
    CHECK(folder.run({"denoise", "b.exr", "-o", "b.exr"}).exit_code == 1);
    CHECK(folder.run({"denoise", "b.exr", "-o", "c.png"}).exit_code == 2);
    // Layers in float16 are denoised one by one, as their sum is the beauty up to rounding; layers whose sum
    // is not are not.
    REQUIRE(folder.render("half.exr", {"--half"}).exit_code == 0);
    REQUIRE(folder.run({"denoise", "half.exr"}).exit_code == 0);
    check_denoised(folder.read("half_denoised.exr"), 3.0f);
    ImageChannels other = folder.read("plain.exr");
    for (float& v : other.channels[0]) v += 0.1f;
    for (const char* written_anyway : {"pixelAspectRatio", "screenWindowWidth"})
        other.metadata.erase(written_anyway);
    mote::core::write_exr(folder.file("other.exr"), other);
    REQUIRE(folder.run({"denoise", "other.exr"}).exit_code == 0);
    CHECK(folder.read("other_denoised.exr").metadata.at("denoised").find("the beauty as a whole") !=
          std::string::npos);
}

TEST_CASE("what is missing is said before the render, in one line", "[command][denoise]") {
    const Folder folder;
    const RunResult r = folder.render("a.exr", {"--denoise", "--quiet"}, folder.file("nowhere.so"));
    CHECK(r.exit_code == 1);
    CHECK(r.err.find("pip install pyoidn") != std::string::npos);
    CHECK(r.err.find("nowhere.so") != std::string::npos);
    CHECK(std::count(r.err.begin(), r.err.end(), '\n') == 1);
    CHECK_FALSE(folder.has("a.exr"));
    // Another library than it should be.
    CHECK(folder.render("a.exr", {"--denoise", "--quiet"}, "libm.so.6").err.find("has no function oidn") !=
          std::string::npos);
}

TEST_CASE("pyoidn is found by the Python that is named, then by that of the active environment",
          "[command][denoise]") {
    const Folder folder;
    const std::string package = folder.file("site/pyoidn"), library = "/libOpenImageDenoise.so.2";
    std::filesystem::create_directories(package + "/oidn/lib");
    std::filesystem::copy_file(stand_in + library, package + "/oidn/lib" + library);
    std::filesystem::create_directories(folder.file("env/bin"));
    const auto python = [&](const std::string& path, const std::string& says) {  // with a space in its name
        write_file(path, "#!/bin/sh\necho '" + says + "'\n");
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        return path;
    };
    const std::string named = python(folder.file("my python"), package);
    python(folder.file("env/bin/python3"), package);
    REQUIRE(folder.render("plain.exr", {}).exit_code == 0);
    for (const bool environment : {false, true}) {
        const RunResult r = run_mote(folder, {"denoise", "plain.exr", "-o", "a.exr"}, [&] {
            ::unsetenv("MOTE_OIDN"), ::unsetenv("MOTE_PYTHON");
            ::setenv("VIRTUAL_ENV", folder.file(environment ? "env" : "nowhere").c_str(), 1);
            if (!environment) ::setenv("MOTE_PYTHON", named.c_str(), 1);
        });
        INFO(r.err);
        REQUIRE(r.exit_code == 0);
        if (folder.read("a.exr").metadata.at("denoised").find("9.8.7") == std::string::npos)
            WARN("the loader finds a library of its own: not tested");
    }
}

TEST_CASE("where the library fails the picture is written all the same", "[command][denoise]") {
    const Folder folder;
    const RunResult r = folder.render("a.exr", {"--denoise"}, stand_in, "not today");
    INFO(r.err);
    CHECK(r.exit_code == 0);
    CHECK(r.err.find("not denoised: OpenImageDenoise: ") != std::string::npos);
    CHECK(r.err.find("not today") != std::string::npos);
    const ImageChannels image = folder.read("a.exr");
    CHECK(image.metadata.count("denoised") == 0);
    CHECK(image.rgb("denoised").empty());
    const RunResult alone = folder.run({"denoise", "a.exr"}, stand_in, "not today");
    CHECK(alone.exit_code == 1);
    CHECK(alone.err.find("not today") != std::string::npos);
    CHECK_FALSE(folder.has("a_denoised.exr"));
}

TEST_CASE("compare says when a picture is denoised", "[command][denoise]") {
    const Folder folder;
    REQUIRE(folder.render("plain.exr", {}).exit_code == 0);
    REQUIRE(folder.render("a.exr", {"--denoise", "--seed", "1"}).exit_code == 0);
    REQUIRE(folder.render("b.exr", {"--seed", "1"}).exit_code == 0);
    CHECK(folder.run({"compare", "plain.exr", "b.exr"}).err.empty());
    const RunResult beauty = folder.run({"compare", "a.exr", "plain.exr", "--json"});
    CHECK(beauty.err.find("a.exr also holds a denoised picture") != std::string::npos);
    CHECK(nlohmann::json::parse(beauty.out)["warnings"].size() == 1);
    const RunResult layer = folder.run({"compare", "plain.exr", "a.exr", "--layer", "direct:denoised"});
    CHECK(layer.err.find("the layer 'denoised' of a.exr is a picture for the eye") != std::string::npos);
}

TEST_CASE("OpenImageDenoise itself takes most of the error", "[command][denoise]") {
    const Folder folder;
    const RunResult r = folder.render("a.exr", {"--denoise"}, "");
    if (r.exit_code == 1 && r.err.find("is not installed") != std::string::npos) {
        WARN("OpenImageDenoise is not installed: tested with a stand-in alone");
        return;
    }
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    REQUIRE(folder
                .run({"render", "scene.xml", "--integrator", "volpath", "--passes", "512", "--seed", "2",
                      "-t", "1", "-o", "reference.exr"})
                .exit_code == 0);
    const auto error = [&](const std::string& layer) {
        const RunResult c = folder.run({"compare", "a.exr", "reference.exr", "--json", "--layer", layer});
        return nlohmann::json::parse(c.out)["metrics"]["error"]["value"].get<double>();
    };
    const double before = error(""), after = error("denoised:");
    INFO("error " << before << " before, " << after << " after");
    CHECK(after < 0.5 * before);
    CHECK(after > 0.0);
}
