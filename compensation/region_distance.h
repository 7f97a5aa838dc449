// Distances inside the bounding region, as in a homogeneous medium: never beyond its radius.
//
// Engelhardt 2013, Eqs. 10.13 and 10.14 (the latter prints no minus sign; see docs/errata.md):
//   p(t) = s e^(-s t) / (1 - e^(-s d)),   t = -ln(1 - u (1 - e^(-s d))) / s
// As s d -> 0 both become uniform over [0, d]; from 1e-6 on the difference is below single precision.
#pragma once

#include <algorithm>
#include <cmath>

namespace mote::compensation {

/// Exponential distances of extinction s >= 0 [1/m] cut off at d > 0 [m]; d may be infinite where s is not 0.
class RegionDistance {
  public:
    RegionDistance(float extinction, float limit)
        : extinction_(extinction), limit_(limit), uniform_(extinction * limit < 1e-6f) {
        reached_ = uniform_ ? 1.0f : -std::expm1(-extinction * limit);  // 1 - e^(-s d)
    }

    /// Eq. 10.14. For u in [0, 1): a distance in [0, d].
    float sample(float u) const {
        if (uniform_) return u * limit_;
        return std::min(-std::log1p(-u * reached_) / extinction_, limit_);
    }
    /// Eq. 10.13: p(t) [1/m], for t in [0, d].
    float pdf_distance(float t) const {
        return uniform_ ? 1.0f / limit_ : extinction_ * std::exp(-extinction_ * t) / reached_;
    }

  private:
    float extinction_, limit_, reached_;
    bool uniform_;
};

}  // namespace mote::compensation
