#include "viewer/frame.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"

using namespace mote;

namespace {

/// The value of a float16, by its definition.
double from_half(std::uint16_t h) {
    const int exponent = h >> 10 & 31, mantissa = h & 1023;
    const double sign = h & 0x8000 ? -1.0 : 1.0;
    if (exponent == 31) return mantissa ? std::nan("") : sign * core::infinity;
    return exponent == 0 ? sign * std::ldexp(mantissa, -24)
                         : sign * std::ldexp(1024 + mantissa, exponent - 25);
}

struct Frame {
    nlohmann::json header;
    std::vector<double> values;
};
Frame decoded(const viewer::Message& message) {
    std::uint32_t length = 0;
    std::memcpy(&length, message.bytes.data(), 4);
    Frame frame{nlohmann::json::parse(message.bytes.substr(4, length)), {}};
    for (std::size_t at = 4 + length; at < message.bytes.size(); at += 2) {
        std::uint16_t half = 0;
        std::memcpy(&half, message.bytes.data() + at, 2);
        frame.values.push_back(frame.header["scale"].get<double>() * from_half(half));
    }
    return frame;
}

}  // namespace

TEST_CASE("float16: every one of them comes back, and others go to the nearest", "[viewer][frame]") {
    for (std::uint32_t h = 0; h < 65536; ++h) {
        const double value = from_half(std::uint16_t(h));
        if (!std::isfinite(value)) continue;
        CHECK(viewer::to_half(float(value)) == h);
    }
    for (float v = 1e-9f; v < 60000.0f; v *= 1.0173f) {
        const double got = from_half(viewer::to_half(v));
        CHECK(std::abs(got - double(v)) <= std::max(double(v) * std::exp2(-11), std::exp2(-25)));
    }
    CHECK(from_half(viewer::to_half(1e9f)) == 65504.0);
    CHECK(from_half(viewer::to_half(-std::numeric_limits<float>::infinity())) == -65504.0);
    CHECK(std::isnan(from_half(viewer::to_half(std::nanf("")))));
}

TEST_CASE("A frame has the layers in the order of the page, in any unit of light", "[viewer][frame]") {
    const float unit = GENERATE(1.0f, 1e-12f, 1e12f);
    core::ImageChannels image;
    image.width = 2, image.height = 1;
    const std::vector<core::Rgb> a = {unit * core::Rgb(1, 2, 3), unit * core::Rgb(0, 0, 5)};
    image.add_rgb("Albedo", a);
    image.add_rgb("direct", a);
    image.add_rgb("", a);
    image.add("Depth.Z", {1.0f, 2.0f});
    image.add_rgb("Variance", std::vector<core::Rgb>(2, core::Rgb(unit * unit)));
    const Frame frame = decoded(*viewer::encode_frame(image, {{"type", "frame"}}));
    REQUIRE(frame.header["layers"].size() == 4);
    CHECK(frame.header["layers"][0]["name"] == "beauty");
    CHECK(frame.header["layers"][1]["name"] == "direct");
    CHECK(frame.header["layers"][1]["of_sum"] == true);
    CHECK(frame.header["layers"][2]["of_sum"] == false);
    CHECK(frame.header["layers"][3]["name"] == "standard deviation");
    REQUIRE(frame.values.size() == 4 * 6);
    for (std::size_t c = 0; c < 3; ++c) CHECK(frame.values[c] == Approx(unit * float(c + 1)).epsilon(1e-3));
    CHECK(frame.values[18] == Approx(unit).epsilon(1e-3));
}
