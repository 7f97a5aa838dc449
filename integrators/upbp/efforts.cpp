#include "integrators/upbp/efforts.h"

#include <algorithm>

namespace mote::integrators {

PerTechnique best_efforts(const PerTechnique& efforts, const EffortTrial& trial) {
    constexpr int rounds = 100;
    PerTechnique factors = full_efforts;  // over the efforts of the trial
    for (int round = 0; round < rounds; ++round) {
        double variance = trial.variance, work = trial.work;
        for (std::size_t t = 0; t < technique_count; ++t) {
            const double b = trial.benefit[t], x = factors[t];
            variance += b > 0.0 ? b * (1.0 / x - 1.0) : b * (1.0 - x);
            work += trial.technique_work[t] * (factors[t] - 1.0);
        }
        variance = std::max(variance, 1e-3 * trial.variance);
        for (std::size_t t = 0; t < technique_count; ++t) {
            if (!(trial.technique_work[t] > 0.0)) continue;
            const double wanted =
                std::sqrt(std::max(0.0, trial.benefit[t]) * work / (trial.technique_work[t] * variance));
            const double now = std::clamp(efforts[t] * wanted, least_effort, 1.0) / efforts[t];
            factors[t] = std::sqrt(factors[t] * now);  // damped: each depends on all
        }
    }
    PerTechnique best = efforts;
    for (std::size_t t = 0; t < technique_count; ++t)
        best[t] = std::clamp(efforts[t] * factors[t], least_effort, 1.0);
    return best;
}

}  // namespace mote::integrators
