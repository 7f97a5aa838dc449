#include "core/metrics/control_error.h"

#include <cmath>
#include <vector>

namespace mote::core {

double control_scale(std::span<const Rgb> image, const RelativeWeights& weights,
                     std::span<const ControlSample> samples) {
    double of_image = 0.0, of_control = 0.0;
    for (const ControlSample& s : samples) {
        // The weights of errors, to the first power of the light.
        const double w = s.pixels * std::sqrt(weights.weight[s.pixel]);
        of_image += w * mean_of_channels(image[s.pixel]);
        of_control += w * 0.5 * (mean_of_channels(s.a) + mean_of_channels(s.b));
    }
    return of_image > 0.0 && of_control > 0.0 ? of_control / of_image : 1.0;
}

PictureError control_error(std::span<const Rgb> image, const RelativeWeights& weights,
                           std::span<const ControlSample> samples) {
    if (samples.size() < min_control_samples || !(weights.noise_norm > 0.0)) return {};
    double sum = 0.0, before = 0.0, differences = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const ControlSample& s = samples[i];
        const glm::dvec3 f(image[s.pixel]);
        const double x = s.pixels * weights.weight[s.pixel] *
                         glm::dot(f - glm::dvec3(s.a), f - glm::dvec3(s.b)) / 3.0;  // Eq. (2)
        if (i > 0) differences += (x - before) * (x - before);
        sum += x, before = x;
    }
    const auto n = double(samples.size());
    const double variance = n / (2.0 * (n - 1.0)) * differences;  // Eq. (3)
    PictureError result = error_interval({.rest = sum, .variance = variance, .norm = weights.noise_norm});
    if (!(result.high > 0.0)) result.high = result.rule_high;  // X < -1.96 s; no image is without error
    return result;
}

}  // namespace mote::core
