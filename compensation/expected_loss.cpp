#include "compensation/expected_loss.h"

namespace mote::compensation {

double bound_for_loss(double sigma_t, double sigma_s, int steps, double loss) {
    if (expected_loss(residual_fraction(sigma_t, sigma_s, 0.0), steps) <= loss) return 0.0;
    // beta falls as the bound rises: bisection of its logarithm, from a radius of 1e6 mean free paths to
    // 1e-9.
    double low = sigma_t * sigma_t * 1e-12, high = sigma_t * sigma_t * 1e18;
    for (int i = 0; i < 100; ++i) {
        const double middle = std::sqrt(low * high);
        (expected_loss(residual_fraction(sigma_t, sigma_s, middle), steps) > loss ? low : high) = middle;
    }
    return high;
}

}  // namespace mote::compensation
