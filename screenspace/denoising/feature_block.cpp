#include "screenspace/denoising/feature_block.h"

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "core/math/vectorize.h"

namespace mote::screenspace {

using namespace core;

namespace {

// Weighted fits. A block is uneven where its brightest pixel is so many times its mean; the weight of the
// darkest is that of a pixel of this fraction of the mean; and a fit whose energy is further off than this is
// discarded. Found on three boxes with reflected lamps and caustics: a floor of 0.2 to 0.4 does as well,
// 0.03 leaves a fifth more error.
constexpr float uneven_block = 1.5f, darkest_weight = 0.3f;
constexpr double max_correction = 4.0;

}  // namespace

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

bool FeatureBlock::fit(const PixelRectangle& block, const RegressionSettings& settings, std::uint64_t seed) {
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
    find_scales(block);
    fill_matrix(block, settings.noise, seed);
    solve_least_squares(matrix_, coefficients_);
    if (settings.weighted) fit_weighted(block, settings.noise, seed);
    return true;
}

void FeatureBlock::fill_matrix(const PixelRectangle& block, float noise, std::uint64_t seed) {
    matrix_.reset(block.pixels());
    fill_features(block), fill_colours(block), add_noise(noise, seed);
}

void FeatureBlock::fit_weighted(const PixelRectangle& block, float noise, std::uint64_t seed) {
    if (!may_be_uneven(block)) return;
    const std::vector<Rgb> fitted = values_of_fit(block);
    float brightest = 0.0f;
    glm::dvec3 energy(0.0);
    for (const Rgb& value : fitted)
        brightest = max_of(brightest, average(value)), energy += glm::dvec3(value);
    const float mean = average(Rgb(energy / double(fitted.size())));
    if (!(mean > 0.0f) || !(brightest > uneven_block * mean)) return;
    fill_matrix(block, noise, seed);
    for (int c = 0; c < matrix_.columns(); ++c) {
        const std::span<float> column = matrix_.column(c);
        for (std::size_t row = 0; row < column.size(); ++row)
            column[row] /= max_of(average(fitted[row]), 0.0f) / mean + darkest_weight;  // Eq. (2)
    }
    const std::vector<float> before = coefficients_;
    solve_least_squares(matrix_, coefficients_);
    glm::dvec3 kept(0.0);
    for (const Rgb& value : values_of_fit(block)) kept += glm::dvec3(value);
    const auto n = std::size_t(matrix_.features());
    for (std::size_t c = 0; c < 3; ++c) {
        const double factor = kept[int(c)] > 0.0 ? energy[int(c)] / kept[int(c)] : 0.0;
        const bool trusted = factor > 1.0 / max_correction && factor < max_correction;
        for (std::size_t k = c * n; k < (c + 1) * n; ++k)
            coefficients_[k] = trusted ? coefficients_[k] * float(factor) : before[k];
    }
}

bool FeatureBlock::may_be_uneven(const PixelRectangle& block) const {
    // Features lie in [-1, 1], so no value of the fit is above the sum of its coefficients' sizes. Its mean
    // is that of the colours, but for the noise in features, for which there is a tenth of room.
    double bound = 0.0;
    const auto n = std::size_t(matrix_.features());
    for (std::size_t k = 0; k < coefficients_.size(); ++k)
        bound += double(k % n == 0 ? coefficients_[k] : std::fabs(coefficients_[k])) / 3.0;
    const double mean = double(average(Rgb(energy_ / double(block.pixels()))));
    return bound > 0.9 * double(uneven_block) * mean;
}

std::vector<Rgb> FeatureBlock::values_of_fit(const PixelRectangle& block) const {
    std::vector<Rgb> fitted(std::size_t(block.pixels()));
    for (int row = 0; row < block.y1 - block.y0; ++row)
        evaluate(block.x0, block.y0 + row,
                 std::span(fitted).subspan(std::size_t(row * block.width()), std::size_t(block.width())));
    for (std::size_t i = 0; i < fitted.size(); ++i)
        if (!takes_part_[i]) fitted[i] = Rgb(0.0f);
    return fitted;
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
    energy_ = glm::dvec3(0.0);
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x, ++row) {
            const Rgb c =
                takes_part_[row] ? colour_[std::size_t(y) * picture_width_ + std::size_t(x)] : Rgb(0.0f);
            r[row] = c.x, g[row] = c.y, b[row] = c.z;
            energy_ += glm::dvec3(c);
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
