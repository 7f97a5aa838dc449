#include "core/film/exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mote::core {

float adapted_exposure(std::span<const Rgb> pixels) {
    std::vector<double> lit;
    double mean = 0.0;
    for (const Rgb& p : pixels) {
        const double y = 0.2126 * p.x + 0.7152 * p.y + 0.0722 * p.z;
        if (is_finite(p) && y > 0.0) lit.push_back(y), mean += y;
    }
    if (lit.empty()) return 0.0f;
    mean /= double(lit.size());
    // Luminance a thousand times darker than the mean is black to the eye, and would pull a logarithm
    // anywhere.
    double logarithms = 0.0;
    for (const double y : lit) logarithms += std::log2(std::max(y, 1e-3 * mean)) / double(lit.size());
    const auto bright = lit.begin() + std::ptrdiff_t(0.97 * double(lit.size() - 1));
    std::nth_element(lit.begin(), bright, lit.end());
    const double stops = std::min(std::log2(key_value) - logarithms, -std::log2(*bright));
    return float(std::round(100.0 * std::clamp(stops, -100.0, 100.0)) / 100.0);
}

}  // namespace mote::core
