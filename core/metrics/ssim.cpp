// Structural similarity (Wang et al. 2004, Eq. 13), with separable Gaussian windows.
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/metrics/metrics.h"

namespace mote::core {

namespace {

constexpr int window = 11;

std::array<double, window> gaussian_weights() {
    std::array<double, window> w;
    double sum = 0.0;
    for (int i = 0; i < window; ++i) {
        const double x = (i - window / 2) / 1.5;
        sum += w[std::size_t(i)] = std::exp(-0.5 * x * x);
    }
    for (double& x : w) x /= sum;
    return w;
}

// The window's mean at every position wholly inside: (width - 10) x (height - 10) values.
std::vector<double> smoothed(std::span<const double> values, int width, int height) {
    static const std::array<double, window> weights = gaussian_weights();
    const int w = width - window + 1, h = height - window + 1;
    std::vector<double> rows(std::size_t(w) * std::size_t(height), 0.0),
        result(std::size_t(w) * std::size_t(h), 0.0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < w; ++x)
            for (int k = 0; k < window; ++k)
                rows[std::size_t(y) * std::size_t(w) + std::size_t(x)] +=
                    weights[std::size_t(k)] *
                    values[std::size_t(y) * std::size_t(width) + std::size_t(x + k)];
    for (int y = 0; y < h; ++y)
        for (int k = 0; k < window; ++k)
            for (int x = 0; x < w; ++x)
                result[std::size_t(y) * std::size_t(w) + std::size_t(x)] +=
                    weights[std::size_t(k)] * rows[std::size_t(y + k) * std::size_t(w) + std::size_t(x)];
    return result;
}

std::vector<double> product(std::span<const double> a, std::span<const double> b) {
    std::vector<double> values(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) values[i] = a[i] * b[i];
    return values;
}

}  // namespace

double mean_ssim(std::span<const double> image, std::span<const double> reference, int width, int height) {
    if (width < window || height < window) return std::numeric_limits<double>::quiet_NaN();
    if (image.size() != std::size_t(width) * std::size_t(height) || reference.size() != image.size())
        throw std::invalid_argument("the pictures differ in size");
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const auto a = smoothed(image, width, height), r = smoothed(reference, width, height);
    const auto aa = smoothed(product(image, image), width, height),
               rr = smoothed(product(reference, reference), width, height),
               ar = smoothed(product(image, reference), width, height);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double variances = aa[i] - a[i] * a[i] + rr[i] - r[i] * r[i], covariance = ar[i] - a[i] * r[i];
        sum += (2.0 * a[i] * r[i] + c1) * (2.0 * covariance + c2) /
               ((a[i] * a[i] + r[i] * r[i] + c1) * (variances + c2));
    }
    return sum / double(a.size());
}

}  // namespace mote::core
