// Accumulation over frames: still cameras, moving ones over a still world, moving objects and moving light.
// How long a trail lasts is measured.
#include "screenspace/denoising/temporal_accumulation.h"

#include <cmath>
#include <functional>

#include "core/math/random.h"
#include "screenspace/denoising/sequence_denoiser.h"
#include "screenspace/denoising/variance_blend.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::screenspace;

namespace {

constexpr int width = 64, height = 40;
constexpr std::size_t pixels = std::size_t(width) * std::size_t(height);

/// A wall seen straight on, a metre a pixel, and before it a square that moves to the right: what every pixel
/// sees, and the motion to the frame before.
struct Frame {
    std::vector<Vec3> position{pixels}, normal{pixels, Vec3(0, 0, 1)};
    std::vector<std::uint32_t> id = std::vector<std::uint32_t>(pixels, 0);
    std::vector<Vec2> motion{pixels, Vec2(0.0f)};
    std::vector<Vec3> previous;

    /// `pan`: the first column of the wall that is seen; `square`: the left edge of the square, 12 pixels
    /// wide, or nothing.
    explicit Frame(float pan = 0.0f, float pan_before = 0.0f, int square = -100, int square_before = -100) {
        for (std::size_t p = 0; p < pixels; ++p) {
            const int x = int(p % width), y = int(p / width);
            position[p] = Vec3(float(x) + pan, float(y), 0.0f);
            motion[p] = Vec2(pan - pan_before, 0.0f);
            previous.push_back(position[p]);
            if (x < square || x >= square + 12 || y < 14 || y >= 26) continue;
            position[p].z = 5.0f, id[p] = 1;
            motion[p] = Vec2(float(square_before - square), 0.0f);
            previous[p] = position[p] + Vec3(motion[p].x, 0.0f, 0.0f);
        }
    }
    FrameFeatures features() const { return {width, height, position, normal, id, motion, previous}; }
};

Rgb noise_of(std::size_t i, int frame) {
    Rng rng(hash_keys(i, frame));
    Rgb c;
    for (int k = 0; k < 3; ++k) c[k] = 2.0f * rng.next_float();  // mean 1, variance 1 / 3
    return c;
}

double variance_about_one(std::span<const Rgb> colour) {
    double square = 0.0;
    for (const Rgb& c : colour) square += double(glm::dot(c - Rgb(1.0f), c - Rgb(1.0f))) / 3.0;
    return square / double(colour.size());
}

std::vector<Rgb> noisy_frame(int frame) {
    std::vector<Rgb> colour(pixels);
    for (std::size_t p = 0; p < pixels; ++p) colour[p] = noise_of(p, frame);
    return colour;
}

/// Adds frames; the history of each is found in the one before.
struct Accumulated {
    TemporalAccumulation accumulation;
    Frame before;
    bool first = true;

    explicit Accumulated(const AccumulationSettings& settings) : accumulation(settings) {}
    std::vector<Rgb> add(const Frame& now, std::span<const Rgb> colour) {
        std::vector<PixelHistory> history;
        if (!first) history = reproject(now.features(), before.features());
        first = false, before = now;
        return accumulation.add(width, height, history, colour);
    }
};

constexpr float all = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("A still camera converges to the mean", "[denoising][temporal]") {
    Accumulated plain({all, all}), watched({all, 4.0f}), bounded({8.0f, all});
    std::vector<glm::dvec3> sum(pixels, glm::dvec3(0.0));
    const Frame still;
    std::vector<Rgb> a, b, c;
    for (int frame = 0; frame < 64; ++frame) {
        const std::vector<Rgb> colour = noisy_frame(frame);
        for (std::size_t p = 0; p < pixels; ++p) sum[p] += glm::dvec3(colour[p]);
        a = plain.add(still, colour), b = watched.add(still, colour), c = bounded.add(still, colour);
    }
    double most = 0.0;
    for (std::size_t p = 0; p < pixels; ++p)
        most = std::fmax(most, glm::length(glm::dvec3(a[p]) - sum[p] / 64.0));
    CHECK(most < 1e-5);
    // 7680 numbers with a variance of 1 / 3 / 64: the mean square has a relative standard error of 1.6 %.
    CHECK(variance_about_one(a) == Approx(1.0 / 192.0).epsilon(0.08));
    // Looking for changes takes chance for one now and then: four standard errors, so hardly ever.
    CHECK(variance_about_one(b) == Approx(1.0 / 192.0).epsilon(0.12));
    // Eq. (1) with a = 1 / 8: a / (2 - a) of a frame's variance.
    CHECK(variance_about_one(c) == Approx(1.0 / 3.0 / 15.0).epsilon(0.08));
}

TEST_CASE("A camera that moves over a still wall keeps its history", "[denoising][temporal]") {
    Accumulated pan({all, all});
    std::vector<Rgb> result;
    for (int frame = 0; frame < 16; ++frame)
        result = pan.add(Frame(float(2 * frame), float(2 * frame - 2)), noisy_frame(frame));
    // Where the wall came into the picture the history is as long as it has been seen.
    const auto length = pan.accumulation.length();
    for (int x = 0; x < width; ++x)
        CHECK(length[std::size_t(10 * width + x)] == float(std::min(16, (width - 1 - x) / 2 + 1)));
    // Paint of the wall, linear along it, is kept, between pixels too.
    Accumulated painted({all, all});
    for (int frame = 0; frame < 6; ++frame) {
        const Frame now(0.3f * float(frame), 0.3f * float(frame - 1));
        std::vector<Rgb> colour(pixels);
        for (std::size_t p = 0; p < pixels; ++p) colour[p] = Rgb(now.position[p].x, 1.0f, 0.0f);
        result = painted.add(now, colour);
        for (std::size_t p = 0; p < pixels; ++p)
            if (p % width < 50) REQUIRE(std::fabs(result[p].x - colour[p].x) < 1e-4f);
    }
}

TEST_CASE("A moving object leaves no trail, nor is one left in it", "[denoising][temporal]") {
    // White on black, with the object's own motion; by id, by position alone, by nothing (planted).
    const auto trail = [](bool id, bool position) {
        TemporalAccumulation accumulation({all, all});
        Frame before;
        double most = 0.0;
        for (int frame = 0; frame < 10; ++frame) {
            Frame now(0.0f, 0.0f, 5 + 3 * frame, 2 + 3 * frame);
            if (frame == 0) now.motion.assign(pixels, Vec2(0.0f));
            std::vector<Rgb> colour(pixels);
            for (std::size_t p = 0; p < pixels; ++p) colour[p] = Rgb(float(now.id[p]));
            FrameFeatures a = now.features(), b = before.features();
            if (!id) a.id = {}, b.id = {};
            if (!position) a.position = {}, a.previous_position = {}, b.position = {};
            const std::vector<PixelHistory> history = frame ? reproject(a, b) : std::vector<PixelHistory>();
            const auto& result = accumulation.add(width, height, history, colour);
            for (std::size_t p = 0; p < pixels; ++p)
                most = std::fmax(most, std::fabs(double(result[p].x) - double(colour[p].x)));
            before = now;
        }
        return most;
    };
    CHECK(trail(true, true) == 0.0);
    CHECK(trail(true, false) == 0.0);
    CHECK(trail(false, true) == 0.0);
    CHECK(trail(false, false) > 0.4);
}

TEST_CASE("A moving shadow's trail is gone within five frames", "[denoising][temporal]") {
    // Nothing moves but light: a shadow's edge at two pixels a frame, with noise of the light's own size.
    const auto frames_of_trail = [](float change) {
        Accumulated accumulated({32.0f, change});
        const Frame still;
        const auto edge = [](int frame) { return 4 + 2 * std::max(0, frame - 16); };
        std::vector<Rgb> result;
        constexpr int last = 36;
        for (int frame = 0; frame <= last; ++frame) {
            std::vector<Rgb> colour = noisy_frame(frame);
            for (std::size_t p = 0; p < pixels; ++p)
                if (int(p % width) < edge(frame)) colour[p] = Rgb(0.0f);
            result = accumulated.add(still, colour);
        }
        // Columns that the shadow reached `k` frames ago still hold a tenth of the light, or do not.
        for (int k = 0; k < 20; ++k) {
            double light = 0.0;
            for (int y = 0; y < height; ++y)
                for (int x = edge(last - k) - 2; x < edge(last - k); ++x)
                    light += double(result[std::size_t(y * width + x)].x) / (2.0 * height);
            if (light < 0.1) return k;
        }
        return 20;
    };
    const int watched = frames_of_trail(4.0f), all_kept = frames_of_trail(all);
    CAPTURE(watched, all_kept);
    CHECK(watched <= 5);
    CHECK(all_kept > 10);
}

TEST_CASE("What is not finite adds nothing, and the sky has a history", "[denoising][temporal]") {
    Accumulated accumulated({all, all});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Frame sky;
    for (std::size_t p = 0; p < pixels / 2; ++p)
        sky.position[p] = sky.previous[p] = Vec3(p % 2 ? nan : infinity);
    std::vector<Rgb> colour(pixels, Rgb(3.0f)), result;
    for (int frame = 0; frame < 3; ++frame) {
        for (std::size_t p = 0; p < pixels; p += 7) colour[p] = Rgb(frame == 1 ? 3.0f : nan);
        result = accumulated.add(sky, colour);
        if (frame == 0) CHECK(!is_finite(result[7]));  // the regression fills it
    }
    for (std::size_t p = 0; p < pixels; ++p) {
        REQUIRE(result[p] == Rgb(3.0f));
        REQUIRE(accumulated.accumulation.length()[p] == (p % 7 ? 3.0f : 1.0f));
    }
    // No history for a wall that was sky before, nor the other way.
    Frame wall;
    const auto history = reproject(wall.features(), sky.features());
    CHECK_FALSE(history[0].any());
    CHECK_FALSE(reproject(sky.features(), wall.features())[0].any());
    CHECK(history[pixels - 1].any());
    Frame other(0.0f, 0.0f);
    other.normal.assign(pixels, Vec3(1, 0, 0));
    CHECK_FALSE(reproject(other.features(), wall.features())[pixels - 1].any());
    other.normal.clear(), other.motion[5] = Vec2(nan), other.motion[6] = Vec2(infinity);
    CHECK_FALSE(reproject(other.features(), wall.features())[5].any());
    CHECK_FALSE(reproject(other.features(), wall.features())[6].any());
    CHECK(reproject(other.features(), wall.features())[7].any());
}

TEST_CASE("Cameras make the motion of what stands still", "[denoising][temporal]") {
    // x and y by z, 100 pixels a unit, the middle at (32, 20); the other one stands a unit to the right.
    FrameCamera now, before;
    now.world_to_pixels = glm::dmat4x3({100, 0, 0}, {0, 100, 0}, {32, 20, 1}, {0, 0, 0});
    before.world_to_pixels = glm::dmat4x3({100, 0, 0}, {0, 100, 0}, {32, 20, 1}, {-100, 0, 0});
    const std::vector<Vec3> points{{0, 0, 10}, {1, 2, 4}, {0, 0, -1}, Vec3(infinity)};
    const auto motion = camera_motion(points, now, before);
    CHECK(glm::length(motion[0] - Vec2(-10, 0)) < 1e-4f);
    CHECK(glm::length(motion[1] - Vec2(-25, 0)) < 1e-4f);
    CHECK_FALSE(std::isfinite(motion[2].x));
    CHECK_FALSE(std::isfinite(motion[3].x));
    for (const Vec2& m : camera_motion(points, now, now)) CHECK(m == Vec2(0.0f));
}

TEST_CASE("Blending by variance is never worse than the raw picture", "[denoising][variance_blend]") {
    // A denoised picture with a bias b over raw ones with a variance v: b^2 v / (b^2 + v) at best.
    for (const float bias : {0.0f, 0.1f, 0.5f, 2.0f, 20.0f}) {
        std::vector<Rgb> denoised(pixels, Rgb(1.0f + bias)), raw = noisy_frame(1);
        const std::vector<Rgb> variance(pixels, Rgb(1.0f / 3.0f));
        const double error = variance_about_one(blend_by_variance(width, height, denoised, raw, variance));
        const double v = 1.0 / 3.0, best = double(bias * bias) * v / (double(bias * bias) + v);
        CAPTURE(bias, error, best);
        CHECK(error < 1.05 * v);
        CHECK(error < 1.3 * best + 0.03 * v);
    }
    // Without variance it is the raw picture, to rounding; what is not finite stays denoised.
    std::vector<Rgb> raw = noisy_frame(1);
    raw[3].x = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Rgb> one(pixels, Rgb(1.0f)), none(pixels, Rgb(0.0f));
    const auto result = blend_by_variance(width, height, one, raw, none);
    for (std::size_t p = 0; p < pixels; ++p)
        REQUIRE(glm::length(result[p] - (p == 3 ? Rgb(1.0f) : raw[p])) < 1e-6f);
    CHECK_THROWS_AS(blend_by_variance(width, height + 1, one, raw, none), std::invalid_argument);
}

TEST_CASE("A sequence is denoised: texture stays, noise goes", "[denoising][bmfr]") {
    // Stripes of albedo, light that falls off along the wall, noise of the light's own size.
    std::vector<Rgb> albedo(pixels);
    std::vector<std::vector<float>> planes(3, std::vector<float>(pixels));
    const Frame still;
    for (std::size_t p = 0; p < pixels; ++p) {
        albedo[p] = p % 4 < 2 ? Rgb(0.8f, 0.5f, 0.0f) : Rgb(0.1f);
        for (int c = 0; c < 3; ++c) planes[std::size_t(c)][p] = still.position[p][c];
    }
    const auto light = [&](std::size_t p) { return 2.0f - 0.02f * still.position[p].x; };
    const auto error_after = [&](int frames, DenoiserSettings settings, bool variance_known) {
        SequenceDenoiser denoiser(settings);
        std::vector<Rgb> result, colour(pixels), variance(pixels);
        for (int frame = 0; frame < frames; ++frame) {
            for (std::size_t p = 0; p < pixels; ++p) {
                colour[p] = albedo[p] * light(p) * noise_of(p, frame);
                variance[p] = albedo[p] * albedo[p] * light(p) * light(p) / 3.0f;
            }
            DenoiserFrame f{still.features(),
                            {{colour, albedo, {{planes[0], true}, {planes[1], true}, {planes[2], true}}}},
                            {}};
            if (variance_known) f.variance = variance;
            result = denoiser.add(f);
        }
        double square = 0.0, of_noise = 0.0;
        for (std::size_t p = 0; p < pixels; ++p) {
            const Rgb d = result[p] - albedo[p] * light(p);
            square += double(glm::dot(d, d));
            of_noise += double(variance[p].x + variance[p].y + variance[p].z);
        }
        return square / of_noise;
    };
    const double one = error_after(1, {}, false), eight = error_after(8, {}, false);
    CAPTURE(one, eight);
    CHECK(one < 0.02);
    CHECK(eight < 0.3 * one);
    CHECK(error_after(1, {}, true) < 0.1);
    DenoiserSettings accumulation_alone;
    accumulation_alone.regress = false;
    CHECK(error_after(8, accumulation_alone, false) == Approx(0.125).epsilon(0.1));
}

TEST_CASE("A frame is refused whose parts differ in size, the first one too", "[temporal]") {
    const Frame view;
    const std::vector<Rgb> colour = noisy_frame(0);
    DenoiserFrame frame{view.features(), {{colour, {}, {}}}, {}};
    CHECK_NOTHROW(SequenceDenoiser().add(frame));
    const std::vector<std::uint32_t> short_id(pixels - 1, 0);
    frame.features.id = short_id;
    CHECK_THROWS_AS(SequenceDenoiser().add(frame), std::invalid_argument);
    frame.features.id = {};
    frame.variance = std::span(colour).first(5);
    CHECK_THROWS_AS(SequenceDenoiser().add(frame), std::invalid_argument);
    frame.variance = {}, frame.layers.clear();
    CHECK_THROWS_AS(SequenceDenoiser().add(frame), std::invalid_argument);
}
