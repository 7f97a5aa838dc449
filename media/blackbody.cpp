// Planck's law, the CIE 1931 observer, and Rec. 709 primaries.
#include "media/blackbody.h"

#include <algorithm>

namespace mote::media {

using core::Rgb, core::Vec3d;

namespace {

/// Planck's law over its own maximum; wavelength in nanometres. Written with x = hc / (lambda k T).
double relative_planck(double nanometres, double kelvin) {
    constexpr double second_radiation_constant = 1.438776877e7;  // hc / k [nm K]
    constexpr double peak_x = 4.965114231744276;                 // Wien: x (1 - exp(-x))^-1 = 5
    const double x = second_radiation_constant / (nanometres * kelvin);
    const auto shape = [](double y) { return y * y * y * y * y / std::expm1(y); };
    return x > 700.0 ? 0.0 : shape(x) / shape(peak_x);
}

double lobe(double wavelength, double mean, double left, double right) {
    const double t = (wavelength - mean) * (wavelength < mean ? left : right);
    return std::exp(-0.5 * t * t);
}

/// Colour matching functions: Wyman, Sloan & Shirley 2013, Eqs. 4 (multi-lobe fit).
Vec3d observer(double w) {
    return {1.056 * lobe(w, 599.8, 0.0264, 0.0323) + 0.362 * lobe(w, 442.0, 0.0624, 0.0374) -
                0.065 * lobe(w, 501.1, 0.0490, 0.0382),
            0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322),
            1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725)};
}

}  // namespace

Rgb blackbody_rgb(double kelvin) {
    if (!(kelvin > 100.0)) return Rgb(0.0f);
    Vec3d xyz(0.0);
    double luminance_of_one = 0.0;
    for (double w = 360.5; w < 830.0; w += 1.0) {
        xyz += relative_planck(w, kelvin) * observer(w);
        luminance_of_one += observer(w).y;
    }
    xyz /= luminance_of_one;
    const Vec3d rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                    -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                    0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    return Rgb(glm::max(rgb, Vec3d(0.0)));
}

BlackbodyTable::BlackbodyTable(double max_kelvin) {
    const double top = std::clamp(max_kelvin, 1.0, 1e6);
    const std::size_t count = 1024;
    entries_.reserve(count + 1);
    for (std::size_t i = 0; i <= count; ++i)
        entries_.push_back(blackbody_rgb(top * double(i) / double(count)));
    to_entry_ = float(double(count) / top);
}

Rgb BlackbodyTable::at(float kelvin) const {
    if (!(kelvin > 100.0f)) return Rgb(0.0f);
    const float x = std::fmin(kelvin * to_entry_, float(entries_.size() - 1));
    const std::size_t i = std::min(std::size_t(x), entries_.size() - 2);
    return glm::mix(entries_[i], entries_[i + 1], x - float(i));
}

}  // namespace mote::media
