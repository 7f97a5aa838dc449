// A picture of light, noise and filters, for tests of stated errors.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/math/random.h"
#include "core/math/vec.h"

namespace mote::tests::noisy_images {

using namespace mote::core;

inline constexpr int width = 64, height = 48;
inline constexpr std::size_t pixels = std::size_t(width) * std::size_t(height);
using Image = std::vector<Rgb>;
using Filter = std::function<Image(const Image&)>;

/// Stripes beside a smooth half, over two orders of magnitude.
inline Image truth() {
    Image image(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
        const auto x = int(p % width), y = int(p / width);
        const float light = std::exp(4.6f * float(y) / float(height));
        image[p] = light * (x < width / 2 ? Rgb(1.0f, 0.8f, 0.6f) : Rgb(x / 3 % 2 == 0 ? 1.0f : 0.7f));
    }
    return image;
}

/// Standard deviation of a half, relative to the light: now and then ten times as much.
inline float deviation(std::size_t p) { return mix_bits(p) % 50 == 0 ? 2.0f : 0.2f; }

inline Image noisy(const Image& image, std::uint64_t seed) {
    Image result(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
        Rng rng(hash_keys(seed, p));
        const float u = std::sqrt(-2.0f * std::log(1.0f - rng.next_float()));
        result[p] = image[p] * (1.0f + deviation(p) * u * std::cos(6.2831853f * rng.next_float()));
    }
    return result;
}

inline Image boxed(const Image& image, int reach) {
    Image result(pixels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Rgb sum(0.0f);
            float count = 0.0f;
            for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
                for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
                    sum += image[std::size_t(v * width + u)], count += 1.0f;
            result[std::size_t(y * width + x)] = sum / count;
        }
    return result;
}

/// A filter that is not linear: pixels far from their neighbours are pulled to them.
inline Image clamped(const Image& image) {
    Image result = boxed(image, 2);
    for (std::size_t p = 0; p < pixels; ++p)
        if (average(image[p]) < 1.3f * average(result[p])) result[p] = 0.5f * (image[p] + result[p]);
    return result;
}

/// Variance of noisy().
inline Image variance_of_noise(const Image& image) {
    Image variance(pixels);
    for (std::size_t p = 0; p < pixels; ++p) variance[p] = deviation(p) * deviation(p) * image[p] * image[p];
    return variance;
}

inline Image mean_of(const Image& a, const Image& b) {
    Image mean(pixels);
    for (std::size_t p = 0; p < pixels; ++p) mean[p] = 0.5f * (a[p] + b[p]);
    return mean;
}

}  // namespace mote::tests::noisy_images
