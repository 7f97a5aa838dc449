#include "media/tracking_settings.h"

#include <algorithm>
#include <vector>

#include "core/objects/error.h"
#include "core/objects/properties.h"

namespace mote::media {

namespace {

const std::vector<std::string> estimator_names = {"automatic",
                                                  "ray_marching",
                                                  "delta_tracking",
                                                  "ratio_tracking",
                                                  "residual_ratio_tracking",
                                                  "unbiased_ray_marching"};

/// Place of the parameter's word in `known`; the first where it is not given.
std::size_t choice_of(const core::Properties& p, const std::string& name,
                      const std::vector<std::string>& known) {
    const std::string word = p.get_string(name, known.front());
    const auto it = std::find(known.begin(), known.end(), word);
    if (it == known.end())
        throw core::InputError(
            "unknown " + name + " '" + core::printable(word) + "'" + core::suggestion(word, known),
            p.where_of(name));
    return std::size_t(it - known.begin());
}

}  // namespace

const std::string& name_of(TransmittanceEstimator estimator) {
    return estimator_names[std::size_t(estimator)];
}

TrackingSettings tracking_settings_of(const core::Properties& p) {
    TrackingSettings settings;
    settings.transmittance = TransmittanceEstimator(choice_of(p, "transmittance", estimator_names));
    settings.marching_tolerance = p.get_float("marching_tolerance", settings.marching_tolerance);
    if (!(settings.marching_tolerance >= 1e-6 && settings.marching_tolerance <= 1.0))
        throw core::InputError("marching_tolerance must lie between 1e-6 and 1",
                               p.where_of("marching_tolerance"));
    return settings;
}

}  // namespace mote::media
