// The noise of a film: what core/image/relative_error.h makes of the passes' spread.
//
// Passes are Sobol points, whose mean is better than that of as many independent ones. How much better shows
// in blocks: the means of 16 passes spread by a factor gain(16) less than independent passes would have them
// spread. A gain that grows with the number of passes like a power of it, gain(n) = gain(16)^(log2(n) / 4),
// is what scrambled nets show (Owen 1997); where there is none it is 1 and stays 1.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/image/film.h"
#include "core/image/relative_error.h"

namespace mote::core {

namespace {

/// What few blocks say is believed in part: their spread is itself uncertain, above all where pixels share
/// light paths and so all err together.
double believed(double gain, double blocks) {
    const double share = (blocks - 1.0) / (blocks + 1.0);
    return std::clamp(1.0 + share * (gain - 1.0), 0.5, 1.0);
}

}  // namespace

double Film::block_variance_of_mean(const Part& part, std::size_t pixel) const {
    const double blocks = part.passes / block_size;
    double square_of_mean = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (const std::size_t layer : part.beauty_layers) sum += sums_[layer].total[3 * pixel + c];
        square_of_mean += sum * sum / (blocks * blocks) / 3.0;
    }
    const double spread = part.block_squares.total[pixel] / blocks - square_of_mean;
    return std::max(0.0, spread) / (blocks - 1.0) / (double(block_size) * block_size);
}

double Film::gain_of_blocks(const Part& part, std::span<const Rgb> variance,
                            std::span<const double> weights) const {
    const std::uint32_t blocks = part.passes / block_size;
    if (blocks < 2) return 1.0;
    double of_passes = 0.0, of_blocks = 0.0;
    for (std::size_t p = 0; p < pixels(); ++p) {
        of_passes += weights[p] * mean_of_channels(variance[p]);
        of_blocks += weights[p] * block_variance_of_mean(part, p);
    }
    if (!(of_passes > 0.0)) return 1.0;
    const double expected = of_passes * part.passes / (double(blocks) * block_size);
    return std::pow(believed(of_blocks / expected, blocks), std::log2(double(part.passes)) / 4.0);
}

double Film::noise() const {
    if (!has_passes(2)) return std::numeric_limits<double>::infinity();
    std::vector<Rgb> picture(pixels());
    for (std::size_t p = 0; p < pixels(); ++p)
        for (std::size_t c = 0; c < 3; ++c) {
            double mean = 0.0;
            for (const Part& part : parts_) mean += beauty_sum(part, 3 * p + c) / part.passes;
            picture[p][int(c)] = float(mean);
        }
    const RelativeWeights weights = relative_weights(picture, beauty_variance_of_mean(), width_, height_);
    if (!(weights.noise_norm > 0.0)) {
        const bool black =
            std::all_of(picture.begin(), picture.end(), [](const Rgb& c) { return c == Rgb(0.0f); });
        return black ? 0.0 : std::numeric_limits<double>::infinity();
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const std::vector<Rgb> variance = part_variance_of_mean(i);
        double of_passes = 0.0;
        for (std::size_t p = 0; p < pixels(); ++p)
            of_passes += weights.weight[p] * mean_of_channels(variance[p]);
        sum += gain_of_blocks(parts_[i], variance, weights.weight) * of_passes;
    }
    return std::sqrt(sum / weights.noise_norm);
}

}  // namespace mote::core
