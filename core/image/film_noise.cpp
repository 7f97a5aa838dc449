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

double Film::block_variance_of_mean(std::size_t pixel) const {
    const double blocks = passes_ / block_size;
    double square_of_mean = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (const std::size_t layer : beauty_layers_) sum += sums_[layer].total[3 * pixel + c];
        square_of_mean += sum * sum / (blocks * blocks) / 3.0;
    }
    const double spread = block_squares_.total[pixel] / blocks - square_of_mean;
    return std::max(0.0, spread) / (blocks - 1.0) / (double(block_size) * block_size);
}

double Film::noise() const {
    if (passes_ < 2) return std::numeric_limits<double>::infinity();
    std::vector<Rgb> picture(pixels());
    for (std::size_t p = 0; p < pixels(); ++p)
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = 0.0;
            for (const std::size_t layer : beauty_layers_) sum += sums_[layer].at(3 * p + c);
            picture[p][int(c)] = float(sum / passes_);
        }
    const std::vector<Rgb> variance = beauty_variance_of_mean();
    const RelativeWeights weights = relative_weights(picture, variance, width_, height_);
    const std::uint32_t blocks = passes_ / block_size;
    double of_passes = 0.0, of_blocks = 0.0;
    for (std::size_t p = 0; p < pixels(); ++p) {
        of_passes += weights.weight[p] * mean_of_channels(variance[p]);
        if (blocks >= 2) of_blocks += weights.weight[p] * block_variance_of_mean(p);
    }
    if (!(weights.noise_norm > 0.0)) {
        const bool black =
            std::all_of(picture.begin(), picture.end(), [](const Rgb& c) { return c == Rgb(0.0f); });
        return black ? 0.0 : std::numeric_limits<double>::infinity();
    }
    double gain = 1.0;
    if (blocks >= 2 && of_passes > 0.0) {
        const double expected = of_passes * passes_ / (double(blocks) * block_size);
        gain = std::pow(believed(of_blocks / expected, blocks), std::log2(double(passes_)) / 4.0);
    }
    return std::sqrt(gain * of_passes / weights.noise_norm);
}

}  // namespace mote::core
