#include "screenspace/layer_filter/oidn_features.h"

#include <algorithm>

namespace mote::screenspace {

using namespace core;

std::vector<Rgb> between_0_and_1(std::vector<Rgb> values) {
    for (Rgb& v : values) v = is_finite(v) ? glm::clamp(v, Rgb(0.0f), Rgb(1.0f)) : Rgb(0.0f);
    return values;
}

bool is_zero(std::span<const Rgb> values) {
    return std::ranges::all_of(values, [](const Rgb& v) { return v == Rgb(0.0f); });
}

std::vector<Rgb> without_noise(const OidnLibrary& library, OidnLibrary::Feature which, int width, int height,
                               std::vector<Rgb> values) {
    return is_zero(values) ? values : library.denoised_feature(which, width, height, values);
}

}  // namespace mote::screenspace
