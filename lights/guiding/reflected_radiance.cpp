#include "lights/guiding/reflected_radiance.h"

#include <cmath>
#include <stdexcept>

namespace mote::lights {

void ReflectedMoments::add(std::span<const ReflectedSample> samples) {
    samples_ += double(samples.size());
    for (const ReflectedSample& s : samples) squares_ += double(s.radiance) * double(s.radiance);
}

void ReflectedMoments::scale(double factor) { samples_ *= factor, squares_ *= factor; }

ExpectedRadiance ReflectedMoments::expected() const {
    if (!(samples_ > 0.0)) return {};
    return {float(std::sqrt(squares_ / samples_)), true};
}

void ReflectedField::add(std::vector<ReflectedSample>& samples) {
    for (const ReflectedSample& s : samples)
        if (!(s.radiance >= 0.0f) || !std::isfinite(s.radiance))
            throw std::invalid_argument("a sample of reflected radiance is no radiance");
    tree_.add(samples);
}

}  // namespace mote::lights
