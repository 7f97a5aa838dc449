#include "session/compare.h"

namespace mote::session {

core::ImageMetrics measure(const MeasuredPicture& image, const MeasuredPicture& reference, int width,
                           int height) {
    return core::compare_images(image.pixels, reference.pixels, width, height,
                                {image.variance, reference.variance});
}

core::ImageMetrics measure(const MeasuredPicture& image, const core::ReferencePair& references,
                           const core::PairMean& mean, int width, int height) {
    core::ImageMetrics m = measure(image, {mean.picture, mean.variance}, width, height);
    if (m.non_finite_either > 0) return m;
    const core::RelativeError e =
        core::relative_error(image.pixels, references, width, height, image.variance);
    m.error = e.error, m.error_standard_error = e.error_standard_error, m.bias = e.bias;
    if (!image.variance.empty()) m.bias_standard_error = e.bias_standard_error, m.noise = e.noise;
    return m;
}

}  // namespace mote::session
