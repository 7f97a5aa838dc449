#include "screenspace/denoising/sequence_denoiser.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "screenspace/denoising/refined_regression.h"
#include "screenspace/denoising/variance_blend.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// Smallest albedo that light is divided by; channels below it keep their reflected light as it is.
constexpr float min_albedo = 0.01f;

bool divisible(float albedo) { return albedo > min_albedo && std::isfinite(albedo); }

/// Light before it is reflected. A channel that is not reflected takes the mean of the others: zero would be
/// wrong, and the neighbours are fitted to it. Nothing (NaN) where none is.
Rgb divided(const Rgb& colour, const Rgb& albedo) {
    Rgb light(0.0f);
    float sum = 0.0f;
    int known = 0;
    for (int c = 0; c < 3; ++c)
        if (divisible(albedo[c])) light[c] = colour[c] / albedo[c], sum += light[c], ++known;
    for (int c = 0; c < 3; ++c)
        if (!divisible(albedo[c]))
            light[c] = known ? sum / float(known) : std::numeric_limits<float>::quiet_NaN();
    return light;
}

std::vector<Rgb> divided(const DenoiserLayer& layer) {
    std::vector<Rgb> result(layer.colour.begin(), layer.colour.end());
    if (!layer.albedo.empty())
        tbb::parallel_for(std::size_t(0), result.size(),
                          [&](std::size_t p) { result[p] = divided(result[p], layer.albedo[p]); });
    return result;
}

void multiply_back(std::vector<Rgb>& light, const DenoiserLayer& layer) {
    if (layer.albedo.empty()) return;
    tbb::parallel_for(std::size_t(0), light.size(), [&](std::size_t p) {
        for (int c = 0; c < 3; ++c) {
            const float albedo = layer.albedo[p][c], raw = layer.colour[p][c];
            light[p][c] = divisible(albedo) ? light[p][c] * albedo : std::isfinite(raw) ? raw : 0.0f;
        }
    });
}

void add_to(std::vector<Rgb>& sum, const std::vector<Rgb>& part) {
    if (sum.empty()) sum.assign(part.size(), Rgb(0.0f));
    for (std::size_t p = 0; p < part.size(); ++p) sum[p] += part[p];
}

std::uint64_t count_holes(std::span<const Rgb> colour) {
    return std::uint64_t(
        std::count_if(colour.begin(), colour.end(), [](const Rgb& c) { return !is_finite(c); }));
}

}  // namespace

SequenceDenoiser::SequenceDenoiser(const DenoiserSettings& settings) : settings_(settings) {}

std::span<const float> SequenceDenoiser::history() const {
    return layers_.empty() ? std::span<const float>() : layers_.front().before.length();
}

std::vector<PixelHistory> SequenceDenoiser::find_history(const FrameFeatures& features) const {
    const FrameFeatures before{width_, height_, position_, normal_, id_, {}, {}};
    return reproject(features, before, settings_.rejection);
}

void SequenceDenoiser::remember(const FrameFeatures& f) {
    width_ = f.width, height_ = f.height;
    position_.assign(f.position.begin(), f.position.end());
    normal_.assign(f.normal.begin(), f.normal.end());
    id_.assign(f.id.begin(), f.id.end());
}

SequenceDenoiser::LayerResult SequenceDenoiser::denoise(const DenoiserFrame& frame,
                                                        const DenoiserLayer& layer, LayerHistory& history,
                                                        std::span<const PixelHistory> pixels,
                                                        CancelToken cancelled) {
    if (!layer.albedo.empty() && layer.albedo.size() != layer.colour.size())
        throw std::invalid_argument("albedo and colour differ in size");
    const int width = frame.features.width, height = frame.features.height;
    LayerResult result;
    result.noisy = history.before.add(width, height, pixels, divided(layer));
    if (settings_.regress) {
        RegressionSettings regression = settings_.regression;
        regression.offset += block_offset(frame_, regression.block);
        regression.seed += std::uint64_t(frame_);
        const Regression r =
            settings_.refine
                ? refined_regression(width, height, layer.features, result.noisy, regression, 8, cancelled)
                : block_regression(width, height, layer.features, result.noisy, regression, cancelled);

        result.denoised = history.after.add(width, height, pixels, r.colour);
        multiply_back(result.denoised, layer);
    }
    multiply_back(result.noisy, layer);
    return result;
}

std::vector<Rgb> SequenceDenoiser::add(const DenoiserFrame& frame, bool connected, CancelToken cancelled) {
    frame.features.check();
    if (frame.layers.empty()) throw std::invalid_argument("a frame has no layers");
    if (!frame.variance.empty() && frame.variance.size() != frame.features.pixels())
        throw std::invalid_argument("the variance does not have the size of the frame");
    if (frame_ > 0 && frame.layers.size() != layers_.size())
        throw std::invalid_argument("a frame has other layers than those before it");
    while (layers_.size() < frame.layers.size())
        layers_.push_back({TemporalAccumulation(settings_.before), TemporalAccumulation(settings_.after)});
    filled_ = 0;
    std::vector<PixelHistory> pixels;
    if (frame_ > 0 && connected) pixels = find_history(frame.features);
    std::vector<Rgb> noisy, denoised;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        const LayerResult r = denoise(frame, frame.layers[i], layers_[i], pixels, cancelled);
        filled_ += count_holes(frame.layers[i].colour);
        add_to(noisy, r.noisy);
        if (settings_.regress) add_to(denoised, r.denoised);
    }
    remember(frame.features), ++frame_;
    if (!settings_.regress) return noisy;
    if (!settings_.blend || frame.variance.empty()) return denoised;
    // Remaining fraction of a frame's variance: 1 / n, or less beyond the longest history.
    std::vector<Rgb> variance(frame.variance.begin(), frame.variance.end());
    const std::span<const float> length = history();
    for (std::size_t p = 0; p < variance.size(); ++p) variance[p] /= std::max(length[p], 1.0f);
    return blend_by_variance(frame.features.width, frame.features.height, denoised, noisy, variance);
}

}  // namespace mote::screenspace
