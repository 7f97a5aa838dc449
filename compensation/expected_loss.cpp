#include "compensation/expected_loss.h"

#include <algorithm>

namespace mote::compensation {

double expected_loss(const ExpectedMedium& medium, double bound, int steps) {
    const double beta = medium.beta(bound), all = medium.beta_all();
    if (steps < 0 || !(beta > 0.0) || !(all > 0.0)) return 0.0;
    return std::min(beta / all, 1.0) * std::pow(beta, steps);
}

double bound_for_loss(const ExpectedMedium& medium, int steps, double loss) {
    if (expected_loss(medium, 0.0, steps) <= loss) return 0.0;
    // beta falls as the bound rises: bisection of its logarithm, from a radius of 1e6 mean free paths to
    // 1e-9.
    double low = medium.sigma_t * medium.sigma_t * 1e-12, high = medium.sigma_t * medium.sigma_t * 1e18;
    for (int i = 0; i < 100; ++i) {
        const double middle = std::sqrt(low * high);
        (expected_loss(medium, middle, steps) > loss ? low : high) = middle;
    }
    return high;
}

}  // namespace mote::compensation
