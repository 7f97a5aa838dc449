// mote compare: the numbers, their definitions, and what it refuses.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/formats/pictures/image_file.h"
#include "core/math/random.h"
#include "core/metrics/error_map.h"
#include "core/metrics/metrics.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using namespace mote::core;
using nlohmann::json;

namespace {

using Pixels = std::vector<Rgb>;

void write_picture(const std::string& path, int width, int height, const Pixels& pixels,
                   const std::map<std::string, std::string>& metadata = {}) {
    ImageChannels image;
    image.width = width, image.height = height;
    image.add_rgb("", pixels);
    image.add_rgb("direct", Pixels(pixels.size(), Rgb(0.5f)));
    image.metadata = metadata;
    write_exr(path, image);
}

/// A reference of 16 x 12 pixels of 2, and a picture that is 5 % brighter.
struct Pictures : TemporaryFolder {
    Pixels reference = Pixels(192, Rgb(2.0f)), image = Pixels(192, Rgb(2.1f));
    Pictures() { write(); }
    void write(const std::map<std::string, std::string>& of_image = {},
               const std::map<std::string, std::string>& of_reference = {}) const {
        write_picture(file("a.exr"), 16, 12, image, of_image);
        write_picture(file("r.exr"), 16, 12, reference, of_reference);
    }
    RunResult compare(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"compare", "a.exr", "r.exr"});
        return run_mote(*this, more);
    }
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("compare prints every number with its definition", "[command][compare]") {
    const Pictures folder;
    const RunResult text = folder.compare();
    INFO(text.out << text.err);
    CHECK(text.exit_code == 0);
    CHECK(text.err.empty());
    for (const MetricDefinition& d : metric_definitions()) {
        CHECK(contains(text.out, d.name));
        CHECK(contains(text.out, d.definition));
    }
    CHECK(contains(text.out, "non-finite 0 % of the pixels"));

    const json j = json::parse(folder.compare({"--json"}).out);
    CHECK(j.at("width") == 16);
    CHECK(j.at("non_finite").at("share") == 0.0);
    CHECK(j.at("mean_reference").at("rgb").at(1) == 2.0);
    CHECK(j.at("warnings").empty());
    const ImageMetrics exact = compare_images(folder.image, folder.reference, 16, 12);
    for (const MetricDefinition& d : metric_definitions()) {
        INFO(d.name);
        const json& value = j.at("metrics").at(d.name).at("value");
        if (std::isnan(exact.*d.value))
            CHECK(value.is_null());  // the pictures do not say their variance
        else
            CHECK(value.get<double>() == exact.*d.value);
        CHECK(j.at("metrics").at(d.name).at("definition") == d.definition);
    }
    CHECK(j.at("metrics").at("bias").at("value").get<double>() == Approx(0.05).epsilon(1e-5));
}

TEST_CASE("compare begins with error, bias and what noise explains of it", "[command][compare]") {
    Pictures folder;
    CHECK(contains(folder.compare().out, "error      5 %, bias +5 %\n"));
    // The reference has a noise of 4 %, the image one of 3 %, and both say so.
    Rng rng(3);
    Pixels variance(192, Rgb(0.0064f));
    for (Rgb& p : folder.reference) p = Rgb(2.0f + 0.08f * (rng.next_float() > 0.5f ? 1.0f : -1.0f));
    ImageChannels image;
    image.width = 16, image.height = 12;
    image.add_rgb("", folder.reference), image.add_rgb("Variance", variance);
    write_exr(folder.file("r.exr"), image);
    const json j = json::parse(folder.compare({"--json"}).out).at("metrics");
    const double error = j.at("error").at("value"), error_se = j.at("error_standard_error").at("value");
    CHECK(error_se > 0.002);
    CHECK(std::abs(error - 0.05) < 4.0 * error_se);
    CHECK(j.at("rmse").at("value").get<double>() > 2.0 * 0.06);  // the reference's noise is in there
    CHECK(j.at("noise").at("value").is_null());
    for (Rgb& v : variance) v = Rgb(0.0036f);
    image = {};
    image.width = 16, image.height = 12;
    image.add_rgb("", folder.image), image.add_rgb("Variance", variance);
    write_exr(folder.file("a.exr"), image);
    const json both = json::parse(folder.compare({"--json"}).out).at("metrics");
    const double noise = both.at("noise").at("value");
    // Sum w v / sum w |r|^2 with pixels of 2 +- 0.08: not 3 % exactly, since dark ones have the larger
    // weight.
    CHECK(noise == Approx(0.03).epsilon(0.01));
    CHECK(both.at("bias_standard_error").at("value").get<double>() > 0.0);
    CHECK(contains(folder.compare().out, fmt::format(", noise of the image {:.3g} %\n", 100.0 * noise)));
}

TEST_CASE("compare takes a second reference, whose noise is another one", "[command][compare]") {
    Pictures folder;
    // Both references are off by 30 %: the picture is 5 % too bright.
    Pixels second = folder.reference;
    Rng rng(5);
    for (Pixels* pixels : {&folder.reference, &second})
        for (Rgb& p : *pixels) p *= rng.next_float() < 0.5f ? 1.3f : 0.7f;
    folder.write();
    write_picture(folder.file("s.exr"), 16, 12, second);
    const json one = json::parse(folder.compare({"--json"}).out).at("metrics");
    CHECK(one.at("error").at("value").get<double>() > 0.25);
    const json j = json::parse(folder.compare({"--second", "s.exr", "--json"}).out);
    CHECK(j.at("second_reference") == "s.exr");
    const double bias = j.at("metrics").at("bias").at("value"),
                 error = j.at("metrics").at("error").at("value"),
                 se = j.at("metrics").at("error_standard_error").at("value");
    // 2 x 192 values of +- 30 %: the bias is good to 1.5 %.
    CHECK(std::abs(bias - 0.05) < 4.0 * 0.3 / std::sqrt(384.0));
    CHECK(error >= bias);
    CHECK(error < std::sqrt(0.05 * 0.05 + 4.0 * ((0.05 + se) * (0.05 + se) - 0.05 * 0.05)));
    CHECK(se < 0.1);
    CHECK(contains(folder.compare({"--second", "s.exr"}).out, "and        s.exr"));
    const RunResult same = folder.compare({"--second", "r.exr"});
    CHECK(same.exit_code == 1);
    CHECK(contains(same.err, "is the same picture as the first reference"));
}

TEST_CASE("compare warns of equal seeds", "[command][compare]") {
    const Pictures folder;
    folder.write({{"seed", "3"}}, {{"seed", "3"}});
    CHECK(contains(folder.compare().err, "the pictures have the same seed"));
    folder.write({{"seed", "4"}}, {{"seed", "3"}});
    CHECK_FALSE(contains(folder.compare().err, "seed"));
}

TEST_CASE("compare shows differences amplified, side by side", "[command][compare]") {
    const Pictures folder;
    const RunResult r = folder.compare({"--difference", "x4"});
    INFO(r.out << r.err);
    REQUIRE(r.exit_code == 0);
    CHECK(contains(r.out, "a_difference.png: image, reference, and their difference in luminance times 4"));
    const Bitmap picture = read_bitmap(folder.file("a_difference.png"), false);
    REQUIRE(picture.width == 3 * 16 + 2 * 4);
    REQUIRE(picture.height == 12);
    // The reference of 2 comes to lie at the key value 0.18, so 0.1 too bright, times 4, is 0.036 of red.
    CHECK(picture.pixels[20].x == Approx(0.18).epsilon(0.02));
    CHECK(picture.pixels[0].x == Approx(0.189).epsilon(0.02));
    CHECK(picture.pixels[40].x == Approx(0.036).epsilon(0.05));
    CHECK(picture.pixels[40].z == 0.0f);
    REQUIRE(run_mote(folder, {"compare", "r.exr", "a.exr", "--difference", "8", "-o", "d.png"}).exit_code ==
            0);
    const Bitmap darker = read_bitmap(folder.file("d.png"), false);
    CHECK(darker.pixels[40].x == 0.0f);
    CHECK(darker.pixels[40].z > 0.05f);
    CHECK(folder.compare({"--difference", "four"}).exit_code == 2);
    CHECK(folder.compare({"--difference", "x-4"}).exit_code == 2);
    CHECK(folder.compare({"--difference", "x4", "-o", "d.exr"}).exit_code == 2);
    CHECK(folder.compare({"--difference", "x4", "-o", "m.png", "--map", "m.png"}).exit_code == 1);
    CHECK(folder.compare({"-o", "d.png"}).exit_code == 2);
}

TEST_CASE("compare takes layers of different names", "[command][compare]") {
    const Pictures folder;
    const json j = json::parse(folder.compare({"--json", "--layer", "direct:"}).out);
    CHECK(j.at("mean_image").at("average") == 0.5);
    CHECK(j.at("mean_reference").at("average") == 2.0);
    const RunResult missing = folder.compare({"--layer", "direct:indirect"});
    CHECK(missing.exit_code == 1);
    CHECK(contains(missing.err, "r.exr: there is no layer 'indirect'"));
}

TEST_CASE("compare takes a layer, and bitmaps", "[command][compare]") {
    const Pictures folder;
    const json layer = json::parse(folder.compare({"--json", "--layer", "direct"}).out);
    CHECK(layer.at("metrics").at("mse").at("value") == 0.0);
    CHECK(layer.at("layer") == "direct");
    const RunResult missing = folder.compare({"--layer", "dierct"});
    CHECK(missing.exit_code == 1);
    CHECK(contains(missing.err, "a.exr: there is no layer 'dierct' (did you mean 'direct'?)"));

    write_png(folder.file("half.png"), 16, 12, Pixels(192, Rgb(0.5f)));
    const RunResult bitmap = run_mote(folder, {"compare", "half.png", "r.exr", "--json"});
    CHECK(json::parse(bitmap.out).at("mean_image").at("average").get<double>() == Approx(0.5).epsilon(0.01));
    CHECK(run_mote(folder, {"compare", "half.png", "r.exr", "--layer", "direct"}).exit_code == 1);
}

TEST_CASE("compare reports the share of bad pixels, and numbers that depend on them as null",
          "[command][compare]") {
    Pictures folder;
    folder.image[5].r = std::numeric_limits<float>::quiet_NaN();
    folder.image[6] = Rgb(std::numeric_limits<float>::infinity());
    folder.write();
    const json j = json::parse(folder.compare({"--json", "--map", "map.png"}).out);
    CHECK(j.at("non_finite").at("share").get<double>() == 2.0 / 192);
    CHECK(j.at("non_finite").at("image") == 2);
    CHECK(j.at("non_finite").at("reference") == 0);
    for (const auto& [name, metric] : j.at("metrics").items()) CHECK(metric.at("value").is_null());
    CHECK(j.at("mean_image").at("average").is_null());
    CHECK(j.at("mean_reference").at("average") == 2.0);
    CHECK(contains(folder.compare().out, "non-finite 1.04 % of the pixels (2 in the image, 0 in"));
    const Bitmap map = read_bitmap(folder.file("map.png"), true);
    CHECK(map.pixels[5] == Rgb(1, 0, 1));
    CHECK(map.pixels[6] == Rgb(1, 0, 1));
    CHECK(map.pixels[7] != Rgb(1, 0, 1));
}

TEST_CASE("the map grows lighter with the error", "[command][compare]") {
    Pictures folder;
    folder.image = folder.reference;
    for (int i = 1; i < 100; ++i)  // relative errors from 0.0009 to 1.1
        folder.image[std::size_t(i)] += 2.0f * Rgb(float(9e-4 * std::pow(1220.0, i / 99.0)));
    folder.write();
    const RunResult result = folder.compare({"--map", "map.png"});
    CHECK(result.exit_code == 0);
    CHECK(contains(result.out, "from 0.001 to 1"));
    const Bitmap map = read_bitmap(folder.file("map.png"), false);
    REQUIRE(map.width == 16);
    REQUIRE(map.height == 12);
    for (std::size_t i = 1; i < 100; ++i) CHECK(luminance(map.pixels[i]) >= luminance(map.pixels[i - 1]));
    const Bitmap bytes = read_bitmap(folder.file("map.png"), true);
    CHECK(glm::length(bytes.pixels[0] * 255.0f - Rgb(0x44, 0x01, 0x54)) < 0.01f);
    CHECK(glm::length(bytes.pixels[99] * 255.0f - Rgb(0xfd, 0xe7, 0x25)) < 0.01f);
    // In the middle of the scale, sqrt(0.001): the middle of viridis. d^2 / (r^2 + r^2 / 100) with r = 2.
    const float d = std::sqrt(1e-3f * 4.04f);
    const Rgb middle = error_map(Pixels{Rgb(2.0f + d)}, Pixels{Rgb(2.0f)}, 1, 1)[0];
    CHECK(middle.g == Approx(0.283).epsilon(0.01));  // 0x91 decoded
    CHECK(folder.compare({"--map", "map.jpg"}).exit_code == 2);
}

TEST_CASE("compare refuses pictures of different sizes", "[command][compare]") {
    const Pictures folder;
    write_picture(folder.file("r.exr"), 12, 16, folder.reference);
    const RunResult result = folder.compare({"--map", "map.png"});
    CHECK(result.exit_code == 1);
    CHECK(contains(result.err, "a.exr: has 16 x 12 pixels, the reference r.exr has 12 x 16"));
    CHECK_FALSE(std::filesystem::exists(folder.file("map.png")));
    CHECK(run_mote(folder, {"compare", "a.exr", "nothing.exr"}).exit_code == 1);
    CHECK(run_mote(folder, {"compare", "a.exr"}).exit_code == 2);
}

TEST_CASE("compare warns when the metadata speaks against it", "[command][compare]") {
    const Pictures folder;
    const std::string camera = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    folder.write(
        {{"worldToCamera", camera}, {"sceneHash", "12"}, {"integrator", "mote_vpl"}},
        {{"worldToCamera", "1.0000001 " + camera.substr(2)}, {"sceneHash", "34"}, {"integrator", "path"}});
    CHECK(folder.compare().err.empty());  // the hash covers the integrator: it must differ

    folder.write({{"worldToCamera", camera}, {"sceneHash", "12"}, {"integrator", "path"}},
                 {{"worldToCamera", "0" + camera.substr(1)}, {"sceneHash", "34"}, {"integrator", "path"}});
    const RunResult both = folder.compare({"--json"});
    CHECK(both.exit_code == 0);
    CHECK(contains(both.err, "mote: warning: the pictures come from different cameras"));
    CHECK(contains(both.err, "mote: warning: the pictures come from different scenes"));
    CHECK(json::parse(both.out).at("warnings").size() == 2);
}
