// When a render ends, and how long that will take.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/render/render_driver.h"

namespace mote::core {

/// State that stop rules are tested on: passes in all, passes and seconds of this run, and the noise
/// (infinity: unknown).
struct RenderState {
    std::uint32_t passes = 0, passes_of_this_run = 0;
    double seconds = 0.0, noise = 0.0;
    PictureError error = {};           ///< for StopRule::error
    double seconds_of_previews = 0.0;  ///< among `seconds`: passes take the others
    /// Of loading and building before, and writing after: they count for the time, not for the speed.
    double seconds_beside = 0.0;
    double seconds_to_finish = 0.0;  ///< that Estimator::finish() will take, as far as previews have shown it
    double seconds_per_pass() const {
        return passes_of_this_run > 0 ? (seconds - seconds_of_previews) / passes_of_this_run : 0.0;
    }
};

inline constexpr std::uint32_t noise_rule_from = 8;  ///< fewer passes say too little about their spread

inline constexpr double max_seconds_late = 1.0;  ///< upper bound of the time after the wanted end [s]
/// If true, the noise rule is tested after this pass: after every pass at first, later after every 16th of a
/// power of two, since estimates take time and noise falls slowly. It depends on nothing but the number of
/// passes, or an interruption would change the picture.
inline bool noise_is_due(std::uint32_t passes) {
    return passes % std::max(1u, std::bit_floor(passes) / 16) == 0;
}

/// If true, noise that takes a filter of the whole picture is estimated after this pass: at every fourth of a
/// power of two.
inline bool filtered_noise_is_due(std::uint32_t passes) {
    return passes % std::max(1u, std::bit_floor(passes) / 4) == 0;
}

inline bool must_stop(const StopRule& rule, const RenderState& state) {
    if (rule.passes && state.passes >= *rule.passes) return true;
    // One more pass would end farther from the wanted time than none, or more than a second behind it.
    const double pass = state.seconds_per_pass(), late = std::min(0.5 * pass, max_seconds_late);
    if (rule.seconds && state.passes_of_this_run > 0 &&
        state.seconds_beside + state.seconds + pass - late + state.seconds_to_finish >= *rule.seconds)
        return true;
    if (state.passes < noise_rule_from) return false;
    return (rule.noise && state.noise <= *rule.noise) || (rule.error && state.error.rule_high <= *rule.error);
}

/// Seconds until the first rule will hold, if passes take as long as before; negative where unknown.
inline double seconds_left(const StopRule& rule, const RenderState& state) {
    double left = infinity;
    const double per_pass = state.seconds_per_pass();
    if (rule.passes && per_pass > 0.0)
        left = std::min(left, per_pass * (*rule.passes - std::min(state.passes, *rule.passes)));
    if (rule.seconds)
        left = std::min(left, std::max(0.0, *rule.seconds - state.seconds_beside - state.seconds -
                                                state.seconds_to_finish));
    if (rule.noise && std::isfinite(state.noise) && per_pass > 0.0) {
        // The noise falls as 1 / sqrt(passes).
        const double ratio = state.noise / *rule.noise;
        left = std::min(left, std::max(0.0, per_pass * state.passes * (ratio * ratio - 1.0)));
    }
    if (rule.error && std::isfinite(state.error.rule_high) && per_pass > 0.0) {
        const double ratio = state.error.rule_high / *rule.error;  // at best: bias falls more slowly
        left = std::min(left, std::max(0.0, per_pass * state.passes * (ratio * ratio - 1.0)));
    }
    return std::isfinite(left) ? left : -1.0;
}

}  // namespace mote::core
