#include "screenspace/denoising/feature_block.h"

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "core/math/vectorize.h"

namespace mote::screenspace {

using namespace core;

FeatureScale feature_scale(float lowest, float highest) {
    // Halves first: the difference of two finite numbers may overflow.
    const float centre = 0.5f * lowest + 0.5f * highest, radius = 0.5f * highest - 0.5f * lowest;
    const float rounding = 1e-6f * std::fmax(std::fabs(lowest), std::fabs(highest));
    if (!(radius > rounding) || !(radius > 1e-30f)) return {centre, 0.0f};
    return {centre, 1.0f / radius};
}

int feature_columns(std::span<const FeaturePlane> features) {
    int count = 1;
    for (const FeaturePlane& f : features) count += f.squared ? 2 : 1;
    return count;
}

FeatureBlock::FeatureBlock(int picture_width, std::span<const FeaturePlane> features,
                           std::span<const Rgb> colour, std::span<const std::uint8_t> has_features)
    : picture_width_(std::size_t(picture_width)),
      features_(features),
      colour_(colour),
      has_features_(has_features),
      matrix_(0, feature_columns(features), 3),
      scales_(features.size()),
      coefficients_(3 * std::size_t(feature_columns(features))) {}

bool FeatureBlock::fit(const PixelRectangle& block, float noise, std::uint64_t seed) {
    takes_part_.resize(std::size_t(block.pixels()));
    std::size_t row = 0;
    bool any = false;
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x, ++row) {
            const std::size_t pixel = std::size_t(y) * picture_width_ + std::size_t(x);
            takes_part_[row] = has_features_[pixel] && is_finite(colour_[pixel]);
            any = any || takes_part_[row];
        }
    if (!any) return false;
    matrix_.reset(block.pixels());
    find_scales(block), fill_features(block), fill_colours(block), add_noise(noise, seed);
    solve_least_squares(matrix_, coefficients_);
    return true;
}

void FeatureBlock::find_scales(const PixelRectangle& block) {
    for (std::size_t f = 0; f < features_.size(); ++f) {
        float lowest = infinity, highest = -infinity;
        std::size_t row = 0;
        for (int y = block.y0; y < block.y1; ++y) {
            const float* values = features_[f].values.data() + std::size_t(y) * picture_width_;
            for (int x = block.x0; x < block.x1; ++x, ++row) {
                if (!takes_part_[row]) continue;
                lowest = min_of(lowest, values[x]), highest = max_of(highest, values[x]);
            }
        }
        scales_[f] = feature_scale(lowest, highest);
    }
}

void FeatureBlock::fill_features(const PixelRectangle& block) {
    const std::span<float> ones = matrix_.column(0);
    for (std::size_t row = 0; row < ones.size(); ++row) ones[row] = takes_part_[row] ? 1.0f : 0.0f;
    int column = 1;
    for (std::size_t f = 0; f < features_.size(); ++f) {
        const auto [centre, scale] = scales_[f];
        const std::span<float> to = matrix_.column(column++);
        std::size_t row = 0;
        for (int y = block.y0; y < block.y1; ++y) {
            const float* values = features_[f].values.data() + std::size_t(y) * picture_width_;
            for (int x = block.x0; x < block.x1; ++x, ++row)
                to[row] = takes_part_[row] ? (values[x] - centre) * scale : 0.0f;
        }
        if (!features_[f].squared) continue;
        const std::span<float> squares = matrix_.column(column++);
        for (row = 0; row < to.size(); ++row) squares[row] = to[row] * to[row];
    }
}

void FeatureBlock::fill_colours(const PixelRectangle& block) {
    const std::span<float> r = matrix_.column(matrix_.features()), g = matrix_.column(matrix_.features() + 1),
                           b = matrix_.column(matrix_.features() + 2);
    std::size_t row = 0;
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x, ++row) {
            const Rgb c =
                takes_part_[row] ? colour_[std::size_t(y) * picture_width_ + std::size_t(x)] : Rgb(0.0f);
            r[row] = c.x, g[row] = c.y, b[row] = c.z;
        }
}

void FeatureBlock::add_noise(float noise, std::uint64_t seed) {
    if (!(noise > 0.0f)) return;
    for (int c = 1; c < matrix_.features(); ++c) {
        std::uint64_t key = hash_keys(seed, c);
        for (const std::span<float> column = matrix_.column(c); float& value : column) {
            key = key * 6364136223846793005ull + 1442695040888963407ull;
            const float at_random = float(std::int32_t(key >> 32)) * 0x1p-31f;  // in [-1, 1)
            value += noise * at_random;
        }
    }
    for (int c = 1; c < matrix_.features(); ++c) {
        const std::span<float> column = matrix_.column(c);
        for (std::size_t row = 0; row < column.size(); ++row)
            if (!takes_part_[row]) column[row] = 0.0f;
    }
}

void FeatureBlock::evaluate(int x0, int y, std::span<Rgb> result) const {
    const std::size_t n = std::size_t(matrix_.features());
    const float *r = coefficients_.data(), *g = r + n, *b = g + n;
    for (Rgb& c : result) c = Rgb(r[0], g[0], b[0]);
    std::size_t k = 1;
    for (std::size_t f = 0; f < features_.size(); ++f) {
        const auto [centre, scale] = scales_[f];
        const float* values = features_[f].values.data() + std::size_t(y) * picture_width_ + std::size_t(x0);
        const Rgb linear(r[k], g[k], b[k]);
        ++k;
        const bool squared = features_[f].squared;
        const Rgb square = squared ? Rgb(r[k], g[k], b[k]) : Rgb(0.0f);
        k += squared ? 1 : 0;
        for (std::size_t i = 0; i < result.size(); ++i) {
            const float value = (values[i] - centre) * scale;
            result[i] += value * linear + (value * value) * square;
        }
    }
}

}  // namespace mote::screenspace
