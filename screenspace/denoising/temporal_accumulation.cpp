#include "screenspace/denoising/temporal_accumulation.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <stdexcept>

#include "screenspace/denoising/box_sums.h"

namespace mote::screenspace {

using namespace core;

namespace {

constexpr int change_radius = 3;  // 7 x 7 pixels

/// Sums over the window of a pixel, of pixels that have a history.
struct WindowSums {
    std::vector<float> count, now, now_squared, past, past_squared;

    WindowSums(int width, int height, std::span<const Rgb> colour, std::span<const Rgb> past_colour,
               std::span<const float> length) {
        const std::size_t pixels = colour.size();
        std::vector<float> one(pixels), a(pixels), a2(pixels), b(pixels), b2(pixels);
        for (std::size_t p = 0; p < pixels; ++p) {
            if (!(length[p] > 0.0f) || !is_finite(colour[p])) continue;
            one[p] = 1.0f, a[p] = average(colour[p]), b[p] = average(past_colour[p]);
            a2[p] = a[p] * a[p], b2[p] = b[p] * b[p];
        }
        const auto sums = [&](const std::vector<float>& v) {
            return box_sums(width, height, v, change_radius);
        };
        count = sums(one), now = sums(a), now_squared = sums(a2), past = sums(b), past_squared = sums(b2);
    }
    /// Number of standard errors between the means of a window; 0 where nothing can be said.
    float excess(std::size_t p) const {
        const float n = count[p];
        if (n < 2.0f) return 0.0f;
        const auto variance_of_mean = [n](float sum, float squares) {
            return std::fmax(0.0f, squares / n - sqr(sum / n)) / (n - 1.0f);
        };
        const float v = variance_of_mean(now[p], now_squared[p]) + variance_of_mean(past[p], past_squared[p]);
        const float difference = std::fabs(now[p] - past[p]) / n;
        const float rounding = 1e-5f * std::fmax(std::fabs(now[p]), std::fabs(past[p])) / n;
        return difference > rounding ? difference / std::sqrt(v + sqr(rounding)) : 0.0f;
    }
};

}  // namespace

TemporalAccumulation::TemporalAccumulation(const AccumulationSettings& settings) : settings_(settings) {
    if (!(settings.longest >= 1.0f) || !(settings.change > 0.0f))
        throw std::invalid_argument("a history has at least one frame");
}

void TemporalAccumulation::cut_where_light_changed(int width, int height, std::span<const Rgb> colour,
                                                   std::span<const Rgb> past, std::span<float> length) const {
    if (!std::isfinite(settings_.change)) return;
    const WindowSums sums(width, height, colour, past, length);
    tbb::parallel_for(std::size_t(0), colour.size(), [&](std::size_t p) {
        const float excess = sums.excess(p) / settings_.change;
        if (excess > 1.0f) length[p] /= sqr(excess);
    });
}

const std::vector<Rgb>& TemporalAccumulation::add(int width, int height,
                                                  std::span<const PixelHistory> history,
                                                  std::span<const Rgb> colour) {
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    if (colour.size() != pixels || (!history.empty() && history.size() != pixels))
        throw std::invalid_argument("the frame does not have its size");
    std::vector<Rgb> past(pixels, Rgb(0.0f));
    std::vector<float> length(pixels, 0.0f);
    if (!history.empty() && !mean_.empty())
        tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t p) {
            float sum = 0.0f;
            for (std::size_t k = 0; k < 4; ++k) {
                const float weight = history[p].weight[k];
                const std::size_t q = history[p].pixel[k];
                if (!(weight > 0.0f) || q >= length_.size() || !(length_[q] > 0.0f)) continue;
                past[p] += weight * mean_[q], length[p] += weight * length_[q], sum += weight;
            }
            if (sum > 0.0f && sum != 1.0f) past[p] /= sum, length[p] /= sum;
        });
    cut_where_light_changed(width, height, colour, past, length);
    tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t p) {
        if (!is_finite(colour[p])) {
            if (!(length[p] > 0.0f)) past[p] = colour[p];
            return;
        }
        length[p] = std::fmin(length[p] + 1.0f, settings_.longest);
        past[p] += (colour[p] - past[p]) / length[p];  // Eq. (1)
    });
    mean_ = std::move(past), length_ = std::move(length);
    return mean_;
}

}  // namespace mote::screenspace
