// Pictures put together from quarters of pixels by their filter, and denoised by the stand-in.
#include "screenspace/layer_filter/fine_pixels.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/environment.h"

using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

constexpr int width = 7, height = 5;

class Box final : public PixelFilter {
  public:
    Vec2 sample_offset(const Vec2& u) const override { return u - Vec2(0.5f); }
    float pdf_area(const Vec2& at) const override {
        return std::fabs(at.x) <= 0.5f && std::fabs(at.y) <= 0.5f ? 1.0f : 0.0f;
    }
    float radius() const override { return 0.5f; }
};

/// e^(-2 r^2), up to two pixels away.
class Gaussian final : public PixelFilter {
  public:
    Vec2 sample_offset(const Vec2&) const override { return Vec2(0.0f); }
    float pdf_area(const Vec2& at) const override {
        return std::fabs(at.x) <= 2.0f && std::fabs(at.y) <= 2.0f ? std::exp(-2.0f * glm::dot(at, at)) : 0.0f;
    }
    float radius() const override { return 2.0f; }
};

std::vector<Rgb> quarters(const auto& light) {
    std::vector<Rgb> fine;
    for (int y = 0; y < 2 * height; ++y)
        for (int x = 0; x < 2 * width; ++x)
            fine.push_back(light(0.5f * (float(x) + 0.5f), 0.5f * (float(y) + 0.5f)));
    return fine;
}

}  // namespace

TEST_CASE("a picture is put together from quarters by its filter", "[fine_pixels]") {
    const auto light = [](float x, float y) { return Rgb(x * x + y, 1.0f, x * y); };
    const std::vector<Rgb> fine = quarters(light), boxed = by_pixel_filter(width, height, fine, Box()),
                           smooth = by_pixel_filter(width, height, fine, Gaussian());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t p = std::size_t(y * width + x), q = std::size_t(4 * y * width + 2 * x);
            const Rgb four = 0.25f * (fine[q] + fine[q + 1] + fine[q + 2 * width] + fine[q + 2 * width + 1]);
            CHECK(glm::length(boxed[p] - four) < 1e-5f);
            // By its definition, over all quarters of the picture.
            Vec3d sum(0.0);
            double weights = 0.0;
            for (std::size_t i = 0; i < fine.size(); ++i) {
                const Vec2 at(0.5f * (float(i % (2 * width)) + 0.5f), 0.5f * (float(i / (2 * width)) + 0.5f));
                const double w = double(Gaussian().pdf_area(at - Vec2(float(x) + 0.5f, float(y) + 0.5f)));
                sum += w * Vec3d(fine[i]), weights += w;
            }
            CHECK(glm::length(smooth[p] - Rgb(sum / weights)) < 1e-4f);
        }
    CHECK_THROWS_AS(by_pixel_filter(width + 1, height, fine, Box()), std::invalid_argument);
}

TEST_CASE("quarters are denoised by clean features", "[fine_pixels]") {
    // The stand-in doubles what it gets, and fails where normals were to be denoised and are not.
    const Environment stand_in("MOTE_OIDN", MOTE_BINARY_DIR "/stand_ins");
    const std::vector<Rgb> fine = quarters([](float x, float y) { return Rgb(x, y, 1.0f); });
    const auto denoised = [&](bool sharp) {
        FineFeatures features{2 * width, 2 * height, std::vector<Rgb>(fine.size(), Rgb(0.5f)),
                              std::vector<Vec3>(fine.size(), Vec3(0, 0, -1)), sharp};
        FinePixels pixels(std::move(features), std::make_shared<const OidnLibrary>(),
                          std::make_unique<Box>());
        const std::vector<Rgb> once = pixels.denoised(fine);
        pixels.release();
        CHECK(pixels.denoised(fine) == once);
        return once;
    };
    const std::vector<Rgb> boxed = by_pixel_filter(width, height, fine, Box()), by_lens = denoised(false);
    for (std::size_t p = 0; p < boxed.size(); ++p) CHECK(glm::length(by_lens[p] - 2.0f * boxed[p]) < 1e-5f);
    CHECK_THROWS_AS(denoised(true), InputError);
    const Environment raw("MOTE_STAND_IN_SHARP", "1");
    CHECK(denoised(true) == by_lens);
}
