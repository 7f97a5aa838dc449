// Error metrics: sums over pixels.
#include "core/metrics/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "core/math/trimmed_sum.h"
#include "core/metrics/relative_error.h"

namespace mote::core {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

constexpr MetricDefinition definitions[] = {
    {"error",
     "square root of sum w |d|^2 / sum w |r|^2, without the reference's own noise where that is known; |x|^2 "
     "is the mean over channels, w = 1 / (l + m / 100), l = max(|r'|^2, |r|^2 / 4), r' the mean of the "
     "5 x 5 pixels around without the pixel itself, m the median of l where it is not 0",
     &ImageMetrics::error},
    {"error_standard_error", "of error, from the noise of the reference",
     &ImageMetrics::error_standard_error},
    {"bias", "sum w <r, d> / sum w |r|^2, signed; never more than error", &ImageMetrics::bias},
    {"bias_standard_error",
     "of bias, from the noise of image and reference; too low where pixels share light paths",
     &ImageMetrics::bias_standard_error},
    {"noise", "square root of sum w v / sum w |r|^2, v the variance that the image says it has",
     &ImageMetrics::noise},
    {"mse", "mean over pixels and channels of d^2", &ImageMetrics::mse},
    {"rmse", "square root of mse", &ImageMetrics::rmse},
    {"mae", "mean over pixels and channels of |d|", &ImageMetrics::mae},
    {"mape", "mean over pixels and channels of |d| / (|r| + 0.01)", &ImageMetrics::mape},
    {"smape", "mean over pixels and channels of 2 |d| / (|image| + |r| + 0.01)", &ImageMetrics::smape},
    {"relmse", "mean over pixels and channels of d^2 / (r^2 + 0.01), as in tev and SeeSharp",
     &ImageMetrics::rel_mse},
    {"relmse_trimmed", "relmse without the 0.1 % of the pixels (rounded down) where it is largest",
     &ImageMetrics::rel_mse_trimmed},
    {"mrse", "mean over pixels and channels of d^2 / (r + 0.01)^2, as in pbrt", &ImageMetrics::mrse},
    {"mean_difference", "mean of d / mean of r, over pixels and channels, signed",
     &ImageMetrics::mean_difference},
    {"mean_difference_standard_error",
     "of mean_difference, from the spread of d over pixels as if they were independent and r exact; too low "
     "where pixels share light paths",
     &ImageMetrics::mean_difference_standard_error},
    {"ssim",
     "mean SSIM (Wang et al. 2004) of x / (1 + x), x = luminance / mean luminance of the reference, negative "
     "ones 0; 11 x 11 Gaussian windows inside the picture, sigma 1.5, K1 0.01, K2 0.03, L 1",
     &ImageMetrics::ssim},
};

double finite_or_nan(double sum) { return std::isfinite(sum) ? sum : not_a_number; }

std::array<double, 3> mean_of(std::span<const Rgb> pixels) {
    std::array<double, 3> mean{};
    for (const Rgb& p : pixels)
        for (int c = 0; c < 3; ++c) mean[std::size_t(c)] += double(p[c]);
    for (double& m : mean) m = finite_or_nan(m / double(pixels.size()));
    return mean;
}

double average(const std::array<double, 3>& m) { return (m[0] + m[1] + m[2]) / 3.0; }

void count_non_finite(std::span<const Rgb> image, std::span<const Rgb> reference, ImageMetrics& m) {
    for (std::size_t i = 0; i < image.size(); ++i) {
        const bool a = !is_finite(image[i]), r = !is_finite(reference[i]);
        m.non_finite_image += a, m.non_finite_reference += r, m.non_finite_either += a || r;
    }
}

void make_all_nan(ImageMetrics& m) {
    for (const MetricDefinition& d : definitions) m.*d.value = not_a_number;
}

// `values`: relative squared error per pixel.
double trimmed_mean(std::vector<double> values) {
    const std::size_t left_out = values.size() / 1000;
    return sum_without_largest(values, left_out) / double(values.size() - left_out);
}

void add_errors(std::span<const Rgb> image, std::span<const Rgb> reference, ImageMetrics& m) {
    const double n = 3.0 * double(image.size());
    std::vector<double> relative(image.size());
    for (std::size_t i = 0; i < image.size(); ++i) {
        relative[i] = relative_squared_error(image[i], reference[i]);
        for (int c = 0; c < 3; ++c) {
            const double a = double(image[i][c]), r = double(reference[i][c]), d = a - r;
            m.mse += d * d / n;
            m.mae += std::fabs(d) / n;
            m.mape += std::fabs(d) / (std::fabs(r) + 0.01) / n;
            m.smape += 2.0 * std::fabs(d) / (std::fabs(a) + std::fabs(r) + 0.01) / n;
            m.mrse += d * d / ((r + 0.01) * (r + 0.01)) / n;
        }
    }
    m.rmse = std::sqrt(m.mse);
    m.rel_mse = std::accumulate(relative.begin(), relative.end(), 0.0) / double(relative.size());
    m.rel_mse_trimmed = trimmed_mean(std::move(relative));
}

void add_relative_error(std::span<const Rgb> image, std::span<const Rgb> reference, int width, int height,
                        const KnownVariances& variances, ImageMetrics& m) {
    const bool known = !variances.reference.empty();
    const RelativeWeights weights = relative_weights(reference, variances.reference, width, height);
    const RelativeError e = relative_error(image, reference, weights, variances.image, variances.reference);
    m.error = e.error, m.bias = e.bias;
    m.error_standard_error = known ? e.error_standard_error : not_a_number;
    m.bias_standard_error = variances.image.empty() ? not_a_number : e.bias_standard_error;
    m.noise = variances.image.empty() ? not_a_number : e.noise;
}

// The standard error of the mean of d, over the mean of r.
void add_mean_difference(std::span<const Rgb> image, std::span<const Rgb> reference, ImageMetrics& m) {
    const double n = double(image.size()), mean = m.average_image - m.average_reference;
    double squares = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        double d = 0.0;
        for (int c = 0; c < 3; ++c) d += (double(image[i][c]) - double(reference[i][c])) / 3.0;
        squares += (d - mean) * (d - mean);
    }
    m.mean_difference = mean / m.average_reference;
    m.mean_difference_standard_error =
        n < 2.0 ? not_a_number : std::sqrt(squares / (n - 1.0) / n) / std::fabs(m.average_reference);
}

// Rec. 709, in double precision: the sum of three finite floats may exceed what a float holds.
double luminance_of(const Rgb& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

std::vector<double> tone_mapped(std::span<const Rgb> pixels, double scale) {
    std::vector<double> grey(pixels.size());
    std::transform(pixels.begin(), pixels.end(), grey.begin(), [scale](const Rgb& p) {
        const double x = scale * std::max(luminance_of(p), 0.0);
        return x / (1.0 + x);
    });
    return grey;
}

double tone_mapped_ssim(std::span<const Rgb> image, std::span<const Rgb> reference, int width, int height) {
    double mean = 0.0;
    for (const Rgb& p : reference) mean += luminance_of(p) / double(reference.size());
    if (!(mean > 0.0)) return not_a_number;
    return mean_ssim(tone_mapped(image, 1.0 / mean), tone_mapped(reference, 1.0 / mean), width, height);
}

}  // namespace

double relative_squared_error(const Rgb& image, const Rgb& reference) {
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double r = double(reference[c]), d = double(image[c]) - r;
        sum += d * d / (r * r + 0.01);
    }
    return sum / 3.0;
}

ImageMetrics compare_images(std::span<const Rgb> image, std::span<const Rgb> reference, int width, int height,
                            const KnownVariances& variances) {
    const std::size_t pixels = width < 1 || height < 1 ? 0 : std::size_t(width) * std::size_t(height);
    if (pixels == 0 || image.size() != pixels || reference.size() != pixels)
        throw std::invalid_argument("the pictures differ in size");
    ImageMetrics m;
    m.pixels = pixels;
    count_non_finite(image, reference, m);
    m.mean_image = mean_of(image), m.mean_reference = mean_of(reference);
    m.average_image = average(m.mean_image), m.average_reference = average(m.mean_reference);
    if (m.non_finite_either > 0) {
        make_all_nan(m);
        return m;
    }
    add_errors(image, reference, m);
    add_relative_error(image, reference, width, height, variances, m);
    add_mean_difference(image, reference, m);
    m.ssim = tone_mapped_ssim(image, reference, width, height);
    return m;
}

std::span<const MetricDefinition> metric_definitions() { return definitions; }

}  // namespace mote::core
