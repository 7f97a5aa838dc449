#include "media/tracking_settings.h"

namespace mote::media {

using namespace core;

namespace {

const Choices<TransmittanceEstimator> estimators{
    {"automatic", TransmittanceEstimator::automatic},
    {"ray_marching", TransmittanceEstimator::ray_marching},
    {"delta_tracking", TransmittanceEstimator::delta_tracking},
    {"ratio_tracking", TransmittanceEstimator::ratio_tracking},
    {"residual_ratio_tracking", TransmittanceEstimator::residual_ratio_tracking},
    {"unbiased_ray_marching", TransmittanceEstimator::unbiased_ray_marching}};

}  // namespace

std::string name_of(TransmittanceEstimator estimator) { return estimators.word(estimator); }

const ParameterList<TrackingSettings>& tracking_rows() {
    using S = TrackingSettings;
    static const ParameterList<S> list{
        row("transmittance", &S::transmittance, estimators,
            "Estimator of shadow rays: unbiased_ray_marching (a tenth of the variance of tracking at its "
            "time, and automatic wherever cells vary), residual_ratio_tracking (exact in constant cells), "
            "ratio_tracking, delta_tracking (most variance), or ray_marching (a small bias, 20 to 80 times "
            "the time); "
            "docs/methods/media.md has the table."),
        row("marching_tolerance", &S::marching_tolerance, between(1e-6, 1),
            "Relative error of the optical depth that ray_marching aims at.")};
    return list;
}

}  // namespace mote::media
