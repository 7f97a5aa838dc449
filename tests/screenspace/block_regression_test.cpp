// Block-wise regression on pictures whose answer is known: linear in the features, constant, black, of one
// pixel, with holes, and of every size.
#include "screenspace/denoising/block_regression.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::screenspace;

namespace {

/// A tilted wall and a ball before it, as planes of normals and positions.
struct View {
    int width, height;
    std::vector<std::vector<float>> planes = std::vector<std::vector<float>>(6);

    View(int w, int h, float unit = 1.0f, Vec3 place = Vec3(0.0f)) : width(w), height(h) {
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const Vec2 at((float(x) + 0.5f) / 32.0f, (float(y) + 0.5f) / 32.0f);
                const float r2 = glm::dot(at - Vec2(1.0f), at - Vec2(1.0f));
                Vec3 n = glm::normalize(Vec3(0.2f, -0.3f, 1.0f)), p(at, -1.0f - 0.2f * at.x + 0.3f * at.y);
                if (r2 < 0.5f) n = Vec3(at - Vec2(1.0f), std::sqrt(1.0f - r2)), p = Vec3(at, n.z);
                p = unit * p + place;
                for (int c = 0; c < 3; ++c)
                    planes[std::size_t(c)].push_back(n[c]), planes[std::size_t(c) + 3].push_back(p[c]);
            }
    }
    std::vector<FeaturePlane> features() const {
        std::vector<FeaturePlane> result;
        for (std::size_t i = 0; i < 6; ++i) result.push_back({planes[i], i >= 3});
        return result;
    }
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    Vec3 normal(std::size_t i) const { return {planes[0][i], planes[1][i], planes[2][i]}; }
    Vec3 position(std::size_t i) const { return {planes[3][i], planes[4][i], planes[5][i]}; }
    std::vector<Rgb> colours(const std::function<Rgb(std::size_t)>& of) const {
        std::vector<Rgb> result(pixels());
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = of(i);
        return result;
    }
    Regression regression(std::span<const Rgb> colour, const RegressionSettings& settings = {}) const {
        return block_regression(width, height, features(), colour, settings);
    }
};

double largest_difference(std::span<const Rgb> a, std::span<const Rgb> b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double d = std::fabs(double(a[i][c]) - double(b[i][c]));
            most = std::isfinite(d) ? std::fmax(most, d) : INFINITY;
        }
    return most;
}

Rgb noise_of(std::size_t i) {
    Rng rng(hash_keys(99, i));
    Rgb c;
    for (int k = 0; k < 3; ++k) c[k] = -std::log(1.0f - rng.next_float());  // mean 1, variance 1
    return c;
}

glm::dvec3 sum(std::span<const Rgb> colour) {
    glm::dvec3 s(0.0);
    for (const Rgb& c : colour) s += glm::dvec3(c);
    return s;
}

RegressionSettings without_noise(bool overlapping = true) {
    RegressionSettings settings;
    settings.noise = 0.0f, settings.overlapping = overlapping;
    return settings;
}

}  // namespace

TEST_CASE("Colours that are linear in the features come back to rounding", "[denoising][bmfr]") {
    const View view(80, 53);
    const auto truth = view.colours([&](std::size_t i) {
        const Vec3 n = view.normal(i), p = view.position(i);
        return Rgb(3.0f) + 0.3f * Rgb(n.x, n.y, n.z) + 0.2f * Rgb(p.y, p.z, p.x) + 0.1f * p * p;
    });
    for (const bool overlapping : {false, true})
        for (int frame = 0; frame < 4; ++frame) {
            RegressionSettings settings = without_noise(overlapping);
            settings.offset = block_offset(frame);
            CHECK(largest_difference(view.regression(truth, settings).colour, truth) < 3e-5);
            // Noise in the features is a ridge of its variance, 1e-4 / 3 of theirs.
            settings.noise = 1e-2f;
            CHECK(largest_difference(view.regression(truth, settings).colour, truth) < 5e-3);
        }
    // In colours it would be far more than that: the noise of fits of ten numbers to a thousand is a tenth.
    auto noisy = truth;
    for (std::size_t i = 0; i < noisy.size(); ++i) noisy[i] += 1e-2f * (noise_of(i) - Rgb(1.0f));
    CHECK(largest_difference(view.regression(noisy, without_noise()).colour, truth) > 5e-4);
}

TEST_CASE("Regression has no unit and no place", "[denoising][bmfr]") {
    const View metres(64, 48);
    const auto colour = metres.colours(noise_of);
    const auto expected = metres.regression(colour, without_noise()).colour;
    for (const float unit : {1e-3f, 1e4f, 1e15f}) {
        const View other(64, 48, unit, unit * Vec3(5.0f, -3.0f, 2.0f));
        CAPTURE(unit);
        CHECK(largest_difference(other.regression(colour, without_noise()).colour, expected) < 2e-3);
    }
}

TEST_CASE("Pictures of every size: constant, black, one pixel", "[denoising][bmfr]") {
    for (const auto& [width, height] :
         {std::pair{1, 1}, {2, 1}, {31, 33}, {32, 32}, {33, 1}, {1, 70}, {65, 40}, {100, 37}}) {
        const View view(width, height);
        CAPTURE(width, height);
        for (const float level : {0.0f, 0.7f, 2e4f}) {
            const auto constant = view.colours([&](std::size_t) { return Rgb(level, 0.5f * level, 0.0f); });
            for (const bool overlapping : {false, true}) {
                RegressionSettings settings;
                settings.overlapping = overlapping, settings.offset = block_offset(width);
                const Regression r = view.regression(constant, settings);
                CHECK(largest_difference(r.colour, constant) <= 1e-5 * double(level));
                CHECK(r.filled == 0);
            }
        }
    }
}

TEST_CASE("Holes are filled and counted, pixels without features stay", "[denoising][bmfr]") {
    View view(70, 45);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto truth = view.colours([&](std::size_t i) { return Rgb(2.0f) + 0.1f * view.position(i); });
    auto colour = truth;
    std::uint64_t holes = 0;
    for (std::size_t i = 0; i < colour.size(); i += 17)
        colour[i][int(i % 3)] = i % 2 ? nan : infinity, ++holes;
    const Regression filled = view.regression(colour, without_noise());
    CHECK(filled.filled == holes);
    CHECK(largest_difference(filled.colour, truth) < 3e-5);
    // Sky behind part of it: infinitely far, brighter than all else.
    const auto sky = [&](std::size_t i) { return i % 70 > 40; };
    for (std::size_t i = 0; i < colour.size(); ++i)
        if (sky(i)) {
            for (std::size_t c = 3; c < 6; ++c) view.planes[c][i] = c == 4 ? nan : infinity;
            if (is_finite(colour[i])) colour[i] = Rgb(50.0f) + noise_of(i);
        }
    const Regression before_sky = view.regression(colour, without_noise());
    for (std::size_t i = 0; i < colour.size(); ++i) {
        REQUIRE(is_finite(before_sky.colour[i]));
        if (sky(i) && is_finite(colour[i])) REQUIRE(before_sky.colour[i] == colour[i]);
        if (!sky(i)) REQUIRE(glm::length(before_sky.colour[i] - truth[i]) < 1e-4f);
    }
    // Nothing known at all.
    const auto lost = view.colours([&](std::size_t) { return Rgb(nan); });
    const Regression black = view.regression(lost);
    CHECK(black.filled == lost.size());
    CHECK(largest_difference(black.colour, view.colours([](std::size_t) { return Rgb(0.0f); })) == 0.0);
    CHECK_THROWS_AS(view.regression(std::span(lost).first(5)), std::invalid_argument);
}

TEST_CASE("The energy of a block is kept", "[denoising][bmfr]") {
    const View view(64, 64);
    const auto colour = view.colours(noise_of);
    const glm::dvec3 before = sum(colour);
    RegressionSettings settings = without_noise(false);
    settings.keep_positive = false;
    // To rounding without noise and clamping; with noise to 1e-3 of it.
    const auto kept = [&](const RegressionSettings& s) {
        const glm::dvec3 after = sum(view.regression(colour, s).colour);
        return glm::length(after - before) / glm::length(before);
    };
    CHECK(kept(settings) < 1e-6);
    settings.noise = 1e-2f;
    CHECK(kept(settings) < 1e-3);
    // One bright pixel is spread and not lost, and what clamping adds is counted by hand: at most what a fit
    // of ten numbers can be below zero, here less than a half.
    auto one = view.colours([](std::size_t) { return Rgb(0.0f); });
    one[1000] = Rgb(1024.0f);
    settings.noise = 0.0f;
    CHECK(std::fabs(sum(view.regression(one, settings).colour).x - 1024.0) < 1e-2);
    settings.keep_positive = true;
    const double clamped = sum(view.regression(one, settings).colour).x / 1024.0;
    CHECK(clamped > 1.0);
    CHECK(clamped < 1.5);
}

TEST_CASE("Noise becomes what ten numbers of a thousand carry of it", "[denoising][bmfr]") {
    const View view(96, 96);
    const auto colour = view.colours(noise_of);
    const auto variance_of = [&](const RegressionSettings& settings) {
        const Regression r = view.regression(colour, settings);
        double square = 0.0;
        for (const Rgb& c : r.colour) square += double(glm::dot(c - Rgb(1.0f), c - Rgb(1.0f)));
        return square / (3.0 * double(r.colour.size()));
    };
    // The trace of a projection of at most 10 dimensions, over 1024 rows; 27 independent sums, so +-30 %.
    const double one_grid = variance_of(without_noise(false));
    CHECK(one_grid < 1.4 * 10.0 / 1024.0);
    CHECK(one_grid > 0.3 * 10.0 / 1024.0);
    CHECK(variance_of({}) < one_grid);
}

TEST_CASE("Beside a bright reflection dark pixels stay dark", "[denoising][bmfr]") {
    // A lamp in the middle, in the features and 100 times as bright as the wall, with noise in proportion to
    // the light.
    View view(64, 64);
    std::vector<float> lamp(view.pixels());
    for (std::size_t i = 0; i < lamp.size(); ++i)
        lamp[i] = std::abs(int(i % 64) - 30) < 8 && std::abs(int(i / 64) - 34) < 5 ? 1.0f : 0.0f;
    const auto truth = [&](std::size_t i) { return 0.05f + 0.02f * view.position(i).x + 5.0f * lamp[i]; };
    const auto colour = view.colours([&](std::size_t i) {
        return Rgb(-std::log(1.0f - to_unit_float(std::uint32_t(hash_keys(i) >> 32)))) * truth(i);
    });
    std::vector<FeaturePlane> features = view.features();
    features.push_back({lamp, false});
    const auto dark_error = [&](bool weighted, glm::dvec3* energy = nullptr) {
        RegressionSettings settings = without_noise(false);
        settings.weighted = weighted, settings.keep_positive = energy == nullptr;
        const Regression r = block_regression(64, 64, features, colour, settings);
        if (energy) *energy = sum(r.colour);
        double square = 0.0, count = 0.0;
        for (std::size_t i = 0; i < lamp.size(); ++i)
            if (lamp[i] == 0.0f)
                square += std::pow(double(r.colour[i].x) / double(truth(i)) - 1.0, 2), count += 1.0;
        return std::sqrt(square / count);
    };
    // 11 numbers of 1024 pixels carry a tenth of the noise; the lamp's factor adds at most its own, one over
    // the root of 150.
    glm::dvec3 energy;
    dark_error(true, &energy);
    CHECK(glm::length(energy - sum(colour)) < 1e-5 * glm::length(sum(colour)));
    CHECK(dark_error(true) < 0.6 * dark_error(false));  // which is as the paper has it
}

TEST_CASE("One thread and many make the same bits", "[denoising][bmfr]") {
    const View view(130, 75);
    const auto colour = view.colours(noise_of);
    const auto many = view.regression(colour).colour;
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK((view.regression(colour).colour == many));
}
