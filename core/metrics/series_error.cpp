// Sums over pixels in index order.
#include "core/metrics/series_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace mote::core {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The picture, black where it is not finite and does not count.
std::vector<Rgb> finite(std::span<const Rgb> picture, std::span<const std::uint8_t> counted) {
    std::vector<Rgb> result(picture.begin(), picture.end());
    for (std::size_t p = 0; p < std::min(result.size(), counted.size()); ++p)
        if (!counted[p] && !is_finite(result[p])) result[p] = Rgb(0.0f);
    return result;
}

/// Mean of independent values and its standard error; NaN for one.
struct MeanOf {
    double mean = 0.0, standard_error = unknown;
    explicit MeanOf(std::span<const double> values) {
        const double n = double(values.size());
        for (const double v : values) mean += v / n;
        double squares = 0.0;
        for (const double v : values) squares += (v - mean) * (v - mean);
        if (values.size() > 1) standard_error = std::sqrt(squares / (n - 1.0) / n);
    }
};

double root(double square) { return std::sqrt(std::max(square, 0.0)); }
/// The standard error of root(square): of the upper end, since the lower may be negative.
double error_of_root(double square, double standard_error) {
    return std::sqrt(std::max(square, 0.0) + standard_error) - root(square);
}

}  // namespace

ErrorMeasure::ErrorMeasure(std::span<const Rgb> reference, std::span<const Rgb> variance, int width,
                           int height, std::span<const std::uint8_t> counted)
    : a_(finite(reference, counted)), b_(a_) {
    if (reference.size() != std::size_t(width) * std::size_t(height))
        throw std::invalid_argument("the pictures differ in size");
    const std::vector<Rgb> known = finite(variance, counted);
    weight_ = relative_weights(a_, known, width, height).weight;
    for (const Rgb& v : known) subtracted_.push_back(mean_of_channels(v));
    count(counted);
}

ErrorMeasure::ErrorMeasure(const ReferencePair& pair, int width, int height,
                           std::span<const std::uint8_t> counted)
    : a_(finite(pair.first, counted)), b_(finite(pair.second, counted)) {
    const std::vector<Rgb> first = finite(pair.first_variance, counted),
                           second = finite(pair.second_variance, counted);
    const PairMean mean = mean_of({a_, b_, first, second});
    weight_ = relative_weights(mean.picture, mean.variance, width, height).weight;
    count(counted);
}

void ErrorMeasure::count(std::span<const std::uint8_t> counted) {
    if (!counted.empty() && counted.size() != a_.size())
        throw std::invalid_argument("the mask differs from the picture in size");
    for (std::size_t p = 0; p < a_.size(); ++p) {
        if (!counted.empty() && !counted[p]) {
            weight_[p] = 0.0;
            continue;
        }
        ++counted_;
        const double noise = subtracted_.empty() ? 0.0 : subtracted_[p];
        norm_ += weight_[p] * (mean_product(a_[p], b_[p]) - noise);
    }
    if (!(norm_ > 0.0)) norm_ = unknown;
}

double ErrorMeasure::product(std::span<const Rgb> x, std::span<const Rgb> y, std::size_t p) const {
    if (!(weight_[p] > 0.0)) return 0.0;
    const glm::dvec3 a(a_[p]), b(b_[p]), u(x[p]), v(y[p]);
    const double own = subtracted_.empty() ? 0.0 : subtracted_[p];
    return weight_[p] * (0.5 * (mean_product(u - a, v - b) + mean_product(v - a, u - b)) - own);
}

double ErrorMeasure::bias_at(std::span<const Rgb> x, std::size_t p) const {
    if (!(weight_[p] > 0.0)) return 0.0;
    const glm::dvec3 a(a_[p]), b(b_[p]), u(x[p]);
    return weight_[p] * 0.5 * (mean_product(a, u - b) + mean_product(b, u - a));
}

std::vector<double> ErrorMeasure::pixel_errors(std::span<const Rgb> image) const {
    if (image.size() != a_.size()) throw std::invalid_argument("the pictures differ in size");
    std::vector<double> errors(image.size());
    for (std::size_t p = 0; p < image.size(); ++p)
        errors[p] = product(image, image, p) * double(counted_) / norm_;
    return errors;
}

SeriesError ErrorMeasure::measure(std::span<const std::vector<Rgb>> images) const {
    if (images.empty()) throw std::invalid_argument("there is no picture to measure");
    std::vector<double> squares, biases;
    double scatter = 0.0, bias_scatter = 0.0;
    for (const std::vector<Rgb>& x : images) {
        if (x.size() != a_.size()) throw std::invalid_argument("the pictures differ in size");
        double sum = 0.0, bias_sum = 0.0;
        for (std::size_t p = 0; p < x.size(); ++p) {
            const double q = product(x, x, p), b = bias_at(x, p);
            sum += q, scatter += q * q, bias_sum += b, bias_scatter += b * b;
        }
        squares.push_back(sum / norm_), biases.push_back(bias_sum / norm_);
    }
    const MeanOf square(squares), bias(biases);
    SeriesError result{square.mean,         root(square.mean), 0.0,     bias.mean,
                       bias.standard_error, unknown,           unknown, unknown};
    result.error_standard_error =
        error_of_root(square.mean, images.size() > 1 ? square.standard_error : std::sqrt(scatter) / norm_);
    if (images.size() == 1) {
        result.bias_standard_error = std::sqrt(bias_scatter) / norm_;
        return result;
    }
    const double pairs = 0.5 * double(images.size()) * double(images.size() - 1);
    double shared = 0.0, shared_scatter = 0.0;
    for (std::size_t p = 0; p < a_.size(); ++p) {
        double q = 0.0;
        for (std::size_t i = 0; i < images.size(); ++i)
            for (std::size_t k = i + 1; k < images.size(); ++k) q += product(images[i], images[k], p) / pairs;
        shared += q, shared_scatter += q * q;
    }
    shared /= norm_;
    result.systematic = root(shared);
    result.systematic_standard_error = error_of_root(shared, std::sqrt(shared_scatter) / norm_);
    result.noise = root(square.mean - shared);
    return result;
}

}  // namespace mote::core
