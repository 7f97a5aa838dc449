// Estimator of a heterogeneous medium, where there is a choice. docs/methods/media.md says what each one
// costs.
#pragma once

#include <string>

#include "core/parameters/parameter_list.h"

namespace mote::media {

/// Estimators of the transmittance along a ray.
enum class TransmittanceEstimator {
    automatic,                ///< unbiased ray marching; residual ratio tracking where all cells are constant
    ray_marching,             ///< deterministic, biased by a stated tolerance
    delta_tracking,           ///< 0 or 1: does a particle pass?
    ratio_tracking,           ///< product of chances to pass (Novák et al. 2014)
    residual_ratio_tracking,  ///< a cell's lower bound analytically, the rest by ratio tracking
    unbiased_ray_marching     ///< equal steps from a random start, and the rest of the exponential's series
};

struct TrackingSettings {
    TransmittanceEstimator transmittance = TransmittanceEstimator::automatic;
    double marching_tolerance =
        1e-3;  ///< of ray marching: relative error of the optical depth that it aims at
};

std::string name_of(TransmittanceEstimator estimator);

/// transmittance and marching_tolerance.
const core::ParameterList<TrackingSettings>& tracking_rows();

}  // namespace mote::media
