#include "core/metrics/halves_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mote::core {

namespace {

constexpr double quantile_of_two = 2.24;  ///< for 95 % in both of two tests

/// Sums over the pixels of a block, each weighted by w.
struct Sums {
    double residuals = 0.0;                        ///< <r_a, r_b>
    double raw = 0.0;                              ///< |a - b|^2
    double shown = 0.0;                            ///< |f_a - f_b|^2
    double both = 0.0;                             ///< <a - b, f_a - f_b>
    double raw_squared = 0.0, left_squared = 0.0;  ///< sum w^2 |a - b|^4, and that times (1 - 2 k)^2
    double v = 0.0;                                ///< v_a + v_b
    double v_squared = 0.0;                        ///< w v_a v_b
    double norm = 0.0, pixels = 0.0;

    void add(double w, const std::array<PictureHalf, 2>& halves, std::size_t p) {
        const Rgb &a = halves[0].passes[p], &b = halves[1].passes[p], &fa = halves[0].shown[p],
                  &fb = halves[1].shown[p];
        const double of_raw = w * product_of_differences(a, b, a, b),
                     of_both = w * product_of_differences(a, b, fa, fb);
        residuals += w * product_of_differences(a, fa, b, fb), raw += of_raw, both += of_both;
        shown += w * product_of_differences(fa, fb, fa, fb);
        raw_squared += of_raw * of_raw, left_squared += sqr(of_raw - 2.0 * of_both);
        const double va = mean_of_channels(halves[0].variance[p]),
                     vb = mean_of_channels(halves[1].variance[p]);
        v += w * (va + vb), v_squared += w * va * w * vb, pixels += 1.0;
        norm += w * mean_product(a, b);
    }
    double k() const { return raw > 0.0 ? both / raw : 0.0; }
    double noise() const { return 0.25 * shown; }
    /// Eq. (4)
    double bound() const { return sqr(noise()) + sqr(sqr(2.0 * k())) * v_squared; }
    /// Eq. (3)
    double variance() const {
        const double others = std::max(0.0, shown - sqr(k()) * raw);
        const double left = raw_squared > 0.0 ? left_squared / raw_squared : 1.0;
        return left * v_squared + (others + std::max(0.0, residuals)) / pixels * v;
    }
};

double sum_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum;
}

MeanInterval interval_of_rest(const SquaredError& e) {
    const double s = std::sqrt(e.variance), above = std::sqrt(e.variance + e.more_above),
                 over = e.rest - e.lowest_rest;
    if (!std::isfinite(over) || !(s > 0.0))
        return {e.rest - normal_quantile * s, e.rest + normal_quantile * above};
    return {e.lowest_rest + s * interval_of_bounded_mean(over / s).low,
            e.lowest_rest + above * interval_of_bounded_mean(over / above).high};
}

}  // namespace

PictureError PictureError::of_all(std::initializer_list<PictureError> errors) {
    PictureError result = *errors.begin();
    double squares = 0.0;
    for (const PictureError& e : errors) {
        squares += e.error * e.error;
        result.low = std::min(result.low, e.low), result.high = std::max(result.high, e.high);
        result.rule_high = std::max(result.rule_high, e.rule_high);
    }
    result.error = std::sqrt(squares / double(errors.size()));
    return result;
}

PictureError error_interval(const SquaredError& e) {
    PictureError result;
    if (!(e.norm > 0.0) || !std::isfinite(e.variance)) return result;
    const double squared = e.noise + e.rest, above = std::sqrt(e.variance + e.more_above);
    const MeanInterval rest = interval_of_rest(e);
    result.error = std::sqrt(std::max(squared, e.noise) / e.norm);
    result.low = std::sqrt(std::max(0.0, e.noise + rest.low) / e.norm);
    result.high = std::sqrt(std::max(e.noise + rest.high, e.noise) / e.norm);
    result.rule_high = std::sqrt((std::max(squared, e.noise) + quantile_of_two * above) / e.norm);  // Eq. (6)
    return result;
}

std::size_t BlockErrors::index_of(std::size_t pixel, int width) const {
    const int x = int(pixel % std::size_t(width)), y = int(pixel / std::size_t(width));
    return std::size_t(y / size * columns + x / size);
}

SquaredError BlockErrors::sum() const {
    SquaredError result{sum_of(noise), sum_of(rest), sum_of(variance), sum_of(norm)};
    result.lowest_rest = -std::sqrt(sum_of(bound));
    return result;
}

PictureError BlockErrors::of_block(std::size_t block) const {
    SquaredError result{noise.at(block), rest.at(block), variance.at(block), norm.at(block)};
    result.lowest_rest = -std::sqrt(bound.at(block));
    return error_interval(result);
}

BlockErrors halves_error(const std::array<PictureHalf, 2>& halves, const RelativeWeights& weights, int width,
                         int height) {
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    bool fits = weights.weight.size() == pixels;
    for (const PictureHalf& half : halves)
        fits = fits && half.passes.size() == pixels && half.shown.size() == pixels &&
               half.variance.size() == pixels;
    if (!fits) throw std::invalid_argument("the halves of a picture differ in size");

    BlockErrors blocks;
    constexpr int size = BlockErrors::size;
    blocks.columns = (width + size - 1) / size, blocks.rows = (height + size - 1) / size;
    std::vector<Sums> sums(std::size_t(blocks.columns) * std::size_t(blocks.rows));
    for (std::size_t p = 0; p < pixels; ++p)
        sums[blocks.index_of(p, width)].add(weights.weight[p], halves, p);
    for (const Sums& block : sums) {
        blocks.noise.push_back(block.noise()), blocks.rest.push_back(block.residuals);
        blocks.variance.push_back(block.variance()), blocks.norm.push_back(block.norm);
        blocks.bound.push_back(block.bound());
    }
    return blocks;
}

void add_variance_of_weights(BlockErrors& blocks, const std::array<PictureHalf, 2>& halves,
                             const std::array<RelativeWeights, 2>& weights, int width) {
    const double norm = sum_of(blocks.norm);
    std::vector<double> differences(blocks.variance.size(), 0.0);
    for (std::size_t p = 0; p < halves[0].passes.size(); ++p) {
        const Rgb &a = halves[0].passes[p], &b = halves[1].passes[p], &fa = halves[0].shown[p],
                  &fb = halves[1].shown[p];
        const double error =
            0.25 * product_of_differences(fa, fb, fa, fb) + product_of_differences(a, fa, b, fb);
        double difference = 0.0;
        for (const auto& [of_half, sign] : {std::pair(&weights[0], 1.0), std::pair(&weights[1], -1.0)})
            if (of_half->norm > 0.0) difference += sign * of_half->weight[p] / of_half->norm;
        differences[blocks.index_of(p, width)] += norm * difference * error;
    }
    for (std::size_t i = 0; i < differences.size(); ++i) blocks.variance[i] += 0.25 * sqr(differences[i]);
}

}  // namespace mote::core
