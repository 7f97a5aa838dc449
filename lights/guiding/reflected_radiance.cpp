#include "lights/guiding/reflected_radiance.h"

#include <cmath>
#include <stdexcept>

namespace mote::lights {

void ReflectedMoments::add(std::span<const ReflectedSample> samples) {
    samples_ += double(samples.size());
    for (const ReflectedSample& s : samples) {
        sum_ += double(s.radiance), squares_ += double(s.radiance) * double(s.radiance);
        indirect_ += double(s.indirect);
    }
    if (!(samples_ > 0.0)) return;
    expected_ = {float(std::sqrt(squares_ / samples_)), float(sum_ / samples_), float(indirect_ / samples_),
                 true};
}

void ReflectedMoments::scale(double factor) {
    samples_ *= factor, sum_ *= factor, squares_ *= factor, indirect_ *= factor;
}

void ReflectedField::add(std::vector<ReflectedSample>& samples) {
    for (const ReflectedSample& s : samples)
        if (!(s.radiance >= 0.0f) || !std::isfinite(s.radiance) || !(s.indirect >= 0.0f) ||
            !std::isfinite(s.indirect))
            throw std::invalid_argument("a sample of reflected radiance is no radiance");
    tree_.add(samples);
}

}  // namespace mote::lights
