// Integrates tables of wavelengths against the CIE matching functions.
#include "core/formats/spectra/spectral_table.h"

#include <algorithm>
#include <array>

namespace mote::core {
namespace {

constexpr double first_wavelength = 360.0, last_wavelength = 830.0, step = 1.0;

/// A Gaussian with different widths (as inverses) on its two sides.
double lobe(double wavelength, double mean, double left, double right) {
    const double t = (wavelength - mean) * (wavelength < mean ? left : right);
    return std::exp(-0.5 * t * t);
}

/// Relative spectral power of CIE standard illuminant D65, every 10 nm from 360 nm; zero beyond 780 nm, where
/// the eye sees nothing.
double daylight(double wavelength) {
    static constexpr std::array<double, 43> table = {
        46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812,
        114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342,
        95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842,
        69.7213, 71.6091, 74.3490, 61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};
    const double x = (wavelength - first_wavelength) / 10.0;
    const auto i = std::size_t(x);
    if (i + 1 >= table.size()) return 0.0;
    const double f = x - double(i);
    return (1.0 - f) * table[i] + f * table[i + 1];
}

double lookup(std::span<const SpectralValue> table, double wavelength) {
    if (table.empty() || wavelength < table.front().wavelength || wavelength > table.back().wavelength)
        return 0.0;
    const auto above =
        std::upper_bound(table.begin(), table.end(), wavelength,
                         [](double w, const SpectralValue& entry) { return w < entry.wavelength; });
    if (above == table.end()) return table.back().value;
    const SpectralValue &b = *above, &a = *(above - 1);
    const double f = (wavelength - a.wavelength) / (b.wavelength - a.wavelength);
    return (1.0 - f) * a.value + f * b.value;
}

}  // namespace

Vec3d xyz_to_rgb(const Vec3d& c) {
    return {3.240479 * c.x - 1.537150 * c.y - 0.498535 * c.z,
            -0.969256 * c.x + 1.875991 * c.y + 0.041556 * c.z,
            0.055648 * c.x - 0.204043 * c.y + 1.057311 * c.z};
}

Vec3d cie_xyz(double w) {
    // Wyman et al. 2013, Section 2.2: sums of piecewise Gaussian lobes.
    return {0.362 * lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * lobe(w, 599.8, 0.0264, 0.0323) -
                0.065 * lobe(w, 501.1, 0.0490, 0.0382),
            0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322),
            1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725)};
}

Rgb spectrum_to_rgb(std::span<const SpectralValue> table, bool emission) {
    Vec3d sum(0.0), white(0.0);
    for (double w = first_wavelength; w <= last_wavelength; w += step) {
        const Vec3d weight = cie_xyz(w) * (emission ? 1.0 : daylight(w));
        sum += weight * lookup(table, w);
        white += weight;
    }
    // Reflectances are relative to the white of the same light, so that the errors of fit and table cancel.
    if (emission) return Rgb(xyz_to_rgb(sum / white.y));
    return Rgb(xyz_to_rgb(sum) / xyz_to_rgb(white));
}

}  // namespace mote::core
