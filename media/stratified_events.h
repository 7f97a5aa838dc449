// Two kinds of events along a ray, measured in the majorant's optical depth: tentative collisions, as a
// Poisson process has them, and one sample in every stratum of a fixed length, anywhere in it.
//
// The product of 1 - sigma_t / majorant over the collisions so far estimates the transmittance to a sample
// without bias, since the samples' places are independent of the collisions; and
//   integral of f(t) dt = sum over samples of f(t) / majorant(t) * stratum
// because the majorant's optical depth grows by majorant dt.
#pragma once

#include "media/tracking_random.h"

namespace mote::media::detail {

class StratifiedEvents {
  public:
    /// `stratum` is the length of a stratum, in optical depth; above 0.
    StratifiedEvents(double stratum, core::Rng& rng)
        : stratum_(stratum), rng_(rng), position_(rng.next_float()), to_sample_(position_ * stratum) {
        to_collision_ = sample_optical_depth(rng);
    }
    /// The optical depth from the last event to the next.
    double next() {
        const double gap = std::fmin(to_sample_, to_collision_);
        at_sample_ = to_sample_ < to_collision_;
        to_sample_ -= gap, to_collision_ -= gap;
        if (at_sample_) {
            const double position = rng_.next_float();
            to_sample_ = (1.0 - position_ + position) * stratum_, position_ = position;
        } else {
            to_collision_ = sample_optical_depth(rng_);
        }
        return gap;
    }
    /// Was the last event a sample? Else a tentative collision.
    bool at_sample() const { return at_sample_; }
    double stratum() const { return stratum_; }

  private:
    double stratum_;
    core::Rng& rng_;
    double position_;  ///< of the last or next sample in its stratum, 0 to 1
    double to_sample_, to_collision_ = 0.0;
    bool at_sample_ = false;
};

}  // namespace mote::media::detail
