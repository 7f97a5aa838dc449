// The version of the library, its status codes, and what needs no handle.
#include <span>

#include "plugins/c/handles.h"
#include "session/compare.h"

using namespace mote;

const char* mote_version(void) { return MOTE_VERSION; }
int mote_version_number(void) { return MOTE_VERSION_NUMBER; }

const char* mote_status_name(mote_status status) {
    switch (status) {
        case MOTE_OK:
            return "MOTE_OK";
        case MOTE_INVALID_ARGUMENT:
            return "MOTE_INVALID_ARGUMENT";
        case MOTE_INPUT_ERROR:
            return "MOTE_INPUT_ERROR";
        case MOTE_BUFFER_TOO_SMALL:
            return "MOTE_BUFFER_TOO_SMALL";
        case MOTE_OUT_OF_MEMORY:
            return "MOTE_OUT_OF_MEMORY";
        case MOTE_INTERNAL_ERROR:
            return "MOTE_INTERNAL_ERROR";
    }
    return "no status";
}

mote_status mote_compare(const float* image, const float* reference, int width, int height,
                         const float* image_variance, const float* reference_variance,
                         mote_metrics* metrics) {
    if (!image || !reference || !metrics || width < 1 || height < 1 ||
        metrics->struct_size != sizeof(mote_metrics))
        return MOTE_INVALID_ARGUMENT;
    c::LastError error;
    return c::guarded(error, [&] {
        const std::size_t pixels = std::size_t(width) * std::size_t(height);
        const auto colours = [&](const float* values) {
            std::vector<core::Rgb> rgb(values ? pixels : 0);
            for (std::size_t i = 0; i < rgb.size(); ++i)
                rgb[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
            return rgb;
        };
        const auto a = colours(image), r = colours(reference), a_variance = colours(image_variance),
                   r_variance = colours(reference_variance);
        const core::ImageMetrics m = session::measure({a, a_variance}, {r, r_variance}, width, height);
        *metrics = {sizeof(mote_metrics),
                    m.error,
                    m.error_standard_error,
                    m.bias,
                    m.bias_standard_error,
                    m.noise,
                    m.mse,
                    m.rmse,
                    m.mae,
                    m.mape,
                    m.smape,
                    m.rel_mse,
                    m.rel_mse_trimmed,
                    m.mrse,
                    m.ssim,
                    m.average_image,
                    m.average_reference,
                    m.non_finite_either};
    });
}
