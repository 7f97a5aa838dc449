// mote denoise --method bmfr: single pictures with and without features, in fog too, and sequences.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using mote::core::ImageChannels;
using mote::core::Rgb;

namespace {

/// A box without a front, with a lamp that is seen; `fog` [1/m]; `x` of the camera; `lamp` [m]: its height.
struct Folder : TemporaryFolder {
    Folder() {
        write_file(file("scene.xml"), R"(<scene version="3.0.0">
            <default name="fog" value="0"/><default name="x" value="0"/>
            <default name="lamp" value="0.9"/>
            <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="50"/>
            <integer name="height" value="38"/><rfilter type="box"/></film><transform name="to_world">
            <lookat origin="$x, 0, 4" target="$x, 0, 0" up="0, 1, 0"/></transform>
            <medium type="homogeneous"><float name="sigma_t" value="$fog"/><float name="albedo" value="0.8"/></medium></sensor>
            <shape type="rectangle"><transform name="to_world"><scale value="3"/><translate z="-1"/></transform>
                <bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.5, 0.4"/></bsdf></shape>
            <shape type="sphere"><float name="radius" value="0.6"/><point name="center" x="-0.6" y="-0.4" z="0"/>
                <bsdf type="diffuse"/></shape>
            <shape type="rectangle"><transform name="to_world"><scale value="0.3"/><rotate x="1" angle="60"/>
                <translate y="$lamp" z="-0.3"/></transform><emitter type="area">
                <rgb name="radiance" value="9, 8, 6"/></emitter></shape>
            </scene>)");
    }
    RunResult run(const std::vector<std::string>& arguments) const {
        const RunResult r = run_mote(*this, arguments);
        INFO(r.err);
        REQUIRE(r.exit_code == 0);
        return r;
    }
    void render(const std::string& output, int passes, int seed,
                const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all = {
            "render", "scene.xml",          "--integrator", "volpath", "--passes", std::to_string(passes),
            "--seed", std::to_string(seed), "-t",           "1",       "-o",       output,
            "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        run(all);
    }
    std::string denoise(const std::string& input, const std::string& output) const {
        return run({"denoise", "--method", "bmfr", input, output, "-t", "1"}).err;
    }
    double error(const std::string& image, const std::string& layer) const {
        const RunResult c = run({"compare", image, "reference.exr", "--json", "--layer", layer});
        return nlohmann::json::parse(c.out)["metrics"]["error"]["value"].get<double>();
    }
};

}  // namespace

TEST_CASE("Regression takes most of the error of one sample a pixel, on surfaces and in fog",
          "[command][bmfr]") {
    const Folder folder;
    for (const std::string fog : {"0", "0.1"}) {
        CAPTURE(fog);
        const std::vector<std::string> set{"-D", "fog=" + fog};
        std::vector<std::string> with = set;
        with.emplace_back("--auxiliary");
        folder.render("a.exr", 1, 1, with), folder.render("b.exr", 1, 1, set);
        folder.render("reference.exr", 256, 2, set);
        const std::string said = folder.denoise("a.exr", "a_denoised.exr");
        CHECK(said.find("with Albedo, Ns, P") != std::string::npos);
        CHECK(folder.denoise("b.exr", "b_denoised.exr").find("without features") != std::string::npos);
        const double raw = folder.error("a.exr", ""),
                     with_features = folder.error("a_denoised.exr", "denoised:"),
                     without = folder.error("b_denoised.exr", "denoised:");
        CAPTURE(raw, with_features, without);
        CHECK(with_features < 0.5 * raw);
        CHECK(without < raw);
        // All other layers are as they were, and the lamp, which is seen, is not smeared.
        const ImageChannels before = mote::core::read_exr(folder.file("a.exr")),
                            after = mote::core::read_exr(folder.file("a_denoised.exr"));
        for (const std::string& name : before.names) {
            CAPTURE(name);
            REQUIRE(after.find(name));
            // Depths of the sky are infinite, nothing is NaN.
            CHECK((*after.find(name) == *before.find(name)));
        }
    }
}

TEST_CASE("Features take a tenth of the error that regression leaves on surfaces", "[command][bmfr]") {
    // The lamp is not in view: one sample a pixel has its edges wrong, whatever the features.
    const Folder folder;
    const std::vector<std::string> set{"-D", "lamp=2.2"};
    std::vector<std::string> with = set;
    with.emplace_back("--auxiliary");
    folder.render("a.exr", 1, 1, with), folder.render("b.exr", 1, 1, set);
    folder.render("reference.exr", 256, 2, set);
    folder.denoise("a.exr", "a_denoised.exr"), folder.denoise("b.exr", "b_denoised.exr");
    CHECK(folder.error("a_denoised.exr", "denoised:") < 0.9 * folder.error("b_denoised.exr", "denoised:"));
}

TEST_CASE("The film's variance holds a denoised picture to the mean", "[command][bmfr]") {
    const Folder folder;
    folder.render("reference.exr", 256, 2), folder.render("a.exr", 32, 1, {"--auxiliary"});
    CHECK(folder.denoise("a.exr", "b.exr").find("blended by the variance") != std::string::npos);
    CHECK(folder.error("b.exr", "denoised:") < folder.error("a.exr", ""));
}

TEST_CASE("A render ends with the regression that mote denoise makes", "[command][bmfr]") {
    const Folder folder;
    folder.render("a.exr", 2, 1, {"-D", "fog=0.1", "--auxiliary"});
    folder.render("b.exr", 2, 1, {"-D", "fog=0.1", "--denoise=bmfr"});
    folder.denoise("a.exr", "c.exr");
    const ImageChannels at_end = mote::core::read_exr(folder.file("b.exr")),
                        later = mote::core::read_exr(folder.file("c.exr"));
    REQUIRE_FALSE(at_end.rgb("denoised").empty());
    CHECK((at_end.rgb("denoised") == later.rgb("denoised")));
    CHECK((at_end.rgb("") == later.rgb("")));
    CHECK(run_mote(folder, {"render", "scene.xml", "--denoise=median"}).exit_code == 2);
}

TEST_CASE("In-scattered light is a feature of fog with shafts", "[command][bmfr]") {
    // A spot through the bars of a grille: nothing but that light has its edges.
    const Folder folder;
    std::string scene = mote::tests::read_file(folder.file("scene.xml"));
    std::string bars =
        R"(<emitter type="spot"><float name="cutoff_angle" value="20"/><rgb name="intensity" value="60"/>
        <transform name="to_world"><lookat origin="-3, 1.5, 0.5" target="0, 0, 0.5" up="0, 1, 0"/></transform></emitter>)";
    for (int i = 0; i < 6; ++i)
        bars += fmt::format(R"(<shape type="rectangle"><transform name="to_world"><scale x="1" y="0.04"/>
            <rotate y="1" angle="90"/><translate x="-1.4" y="{}" z="0.5"/></transform>
            <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>)",
                            0.2 + 0.2 * i);
    scene.insert(scene.rfind("</scene>"), bars);
    write_file(folder.file("scene.xml"), scene);
    const std::vector<std::string> fog{"-D", "fog=0.1", "--auxiliary"};
    folder.render("a.exr", 16, 1, fog), folder.render("reference.exr", 256, 2, {"-D", "fog=0.1"});
    ImageChannels image = mote::core::read_exr(folder.file("a.exr")), without;
    CHECK_FALSE(image.rgb("InScattered").empty());
    without.width = image.width, without.height = image.height;
    for (std::size_t c = 0; c < image.names.size(); ++c)
        if (!image.names[c].starts_with("InScattered.")) without.add(image.names[c], image.channels[c]);
    mote::core::write_exr(folder.file("b.exr"), without);
    CHECK(folder.denoise("a.exr", "c.exr").find("in-scattered light") != std::string::npos);
    CHECK(folder.denoise("b.exr", "d.exr").find("in-scattered light") == std::string::npos);
    const double with = folder.error("c.exr", "denoised:"), less = folder.error("d.exr", "denoised:");
    CAPTURE(with, less);
    CHECK(with < 0.9 * less);
}

TEST_CASE("A sequence uses the frames before, as the camera moves", "[command][bmfr]") {
    const Folder folder;
    for (int frame = 0; frame < 6; ++frame)
        folder.render("f.000" + std::to_string(frame) + ".exr", 1, 10 + frame,
                      {"--auxiliary", "-D", "x=" + std::to_string(0.05 * frame)});
    folder.render("reference.exr", 256, 2, {"-D", "x=0.25"});
    const std::string said = folder.denoise("f.####.exr", "d.####.exr");
    CHECK(said.find("without frames before") != std::string::npos);
    CHECK(said.find("with the frames before") != std::string::npos);
    const double last = folder.error("d.0005.exr", "denoised:");
    folder.denoise("f.0005.exr", "alone.exr");
    const double alone = folder.error("alone.exr", "denoised:");
    CAPTURE(last, alone);
    CHECK(last < 0.9 * alone);
    // Denoising the same frames again gives the same bits.
    folder.denoise("f.####.exr", "e.####.exr");
    CHECK((mote::core::read_exr(folder.file("e.0005.exr")).rgb("denoised") ==
           mote::core::read_exr(folder.file("d.0005.exr")).rgb("denoised")));
    const RunResult none = run_mote(folder, {"denoise", "--method", "bmfr", "g.####.exr", "h.####.exr"});
    CHECK(none.exit_code == 1);
    CHECK(none.err.find("no file is called g.####.exr") != std::string::npos);
    CHECK(run_mote(folder, {"denoise", "--method", "bmfr", "f.####.exr", "one.exr"}).exit_code == 2);
    CHECK(run_mote(folder, {"denoise", "--method", "median", "f.####.exr"}).exit_code == 2);
}
