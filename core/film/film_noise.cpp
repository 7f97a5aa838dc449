// The noise of a film: what core/metrics/relative_error.h makes of the passes' spread, and
// core/film/sobol_gain.h of the spread of blocks of passes. The gain is pooled over the picture, with the
// weights of the noise: the pixels' own variances stay what they are. Every part has a gain of its own. Of a
// layer that was filtered its filter says what is left, or what the filtered halves differ by, which have the
// gain already.
#include <algorithm>
#include <cmath>

#include "core/film/film.h"
#include "core/film/sobol_gain.h"
#include "core/metrics/relative_error.h"

namespace mote::core {

namespace {

/// 1, but for light whose square is no float, or leaves nothing of small values: a power of two near its
/// maximum.
double unit_of(std::span<const Rgb> picture) {
    float brightest = 0.0f;
    for (const Rgb& p : picture) brightest = std::max(brightest, max_component(p));
    const bool usual = brightest == 0.0f || (brightest > 1e-12f && brightest < 1e12f);
    return usual || !std::isfinite(brightest) ? 1.0 : std::exp2(std::floor(std::log2(double(brightest))));
}

}  // namespace

std::vector<Rgb> Film::mean_of_passes() const {
    std::vector<Rgb> picture(pixels());
    for (std::size_t p = 0; p < pixels(); ++p)
        for (std::size_t c = 0; c < 3; ++c) {
            double mean = 0.0;
            for (const Part& part : parts_) {
                double sum = 0.0;
                for (const std::size_t layer : part.beauty_layers) sum += sums_[layer].at(3 * p + c);
                mean += sum / part.passes;
            }
            picture[p][int(c)] = float(mean);
        }
    return picture;
}

bool Film::has_replaced_variance() const {
    return std::any_of(replaced_.begin(), replaced_.end(),
                       [](const Replacement& r) { return !r.variance.empty(); });
}

// A layer and the rest of its part come from the same paths, so the rest has what is left when the layer's
// own variance is taken away, covariance included. Pixel by pixel that may be less than nothing.
double Film::shown_sum(const Part& part, double of_passes, double gain, std::span<const double> weights,
                       double unit) const {
    double rest = of_passes, filtered = 0.0, measured = 0.0;
    for (const std::size_t layer : part.beauty_layers) {
        const std::vector<float>& left = replaced_[layer].variance;
        if (left.empty()) continue;
        const std::vector<Rgb> own = layer_variance_of_mean(layer, unit);
        for (std::size_t p = 0; p < pixels(); ++p) {
            if (weights[p] > 0.0) rest -= weights[p] * mean_of_channels(own[p]);
            (replaced_[layer].halves[0].empty() ? filtered : measured) +=
                weights[p] * double(left[p]) / (unit * unit);
        }
    }
    return gain * (std::max(0.0, rest) + filtered) + measured;
}

Film::GainAndNoise Film::gain_and_noise() const {
    GainAndNoise result;
    if (!has_passes(2)) return result;
    const bool replaced = has_replaced_variance();
    std::vector<Rgb> picture = mean_of_passes();
    const double unit = unit_of(picture);
    for (Rgb& p : picture) p /= float(unit);
    const RelativeWeights weights = relative_weights(picture, beauty_variance_of_mean(unit), width_, height_);
    if (!(weights.norm > 0.0)) {
        const bool black =
            std::all_of(picture.begin(), picture.end(), [](const Rgb& c) { return c == Rgb(0.0f); });
        if (black) result.noise = 0.0;
        return result;
    }
    double independent = 0.0, expected = 0.0, shown = 0.0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const std::vector<Rgb> variance = part_variance_of_mean(i, unit);
        double sum = 0.0, squares = 0.0;
        for (std::size_t p = 0; p < pixels(); ++p) {
            const double v = weights.weight[p] * mean_of_channels(variance[p]);
            sum += v, squares += v * v;
        }
        if (!(squares > 0.0)) continue;
        const std::vector<double> d = parts_[i].blocks.differences(weights.weight, unit, parts_[i].range());
        // A filter weights the errors of pixels, which are independent: what it leaves is as much smaller.
        // Where the film begins later, blocks are fewer: what they cannot say of longer ones is not counted.
        const auto passes = std::uint32_t(std::min<std::uint64_t>(parts_[i].passes, (2ull << d.size()) - 1));
        const double gain = sobol_gain(d, passes, sum * sum / squares);
        independent += sum, expected += gain * sum;
        shown += replaced ? shown_sum(parts_[i], sum, gain, weights.weight, unit) : gain * sum;
    }
    if (independent > 0.0) result.gain = expected / independent;
    // The norm is that of independent passes, whose mean has more noise.
    result.noise = std::sqrt(shown / (weights.norm + independent - expected));
    return result;
}

}  // namespace mote::core
