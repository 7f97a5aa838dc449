#include "integrators/virtual_point_lights/vpl_estimator.h"

namespace mote::integrators {

using namespace core;

std::unique_ptr<Estimator> make_vpl_estimator(const Scene& scene, const RenderOptions& options,
                                              const VplSettings& settings) {
    if (scene.has_media()) return std::make_unique<VplEstimator<true>>(scene, options, settings);
    return std::make_unique<VplEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
