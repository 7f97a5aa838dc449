#include "integrators/photon_map/photon_map_estimator.h"

namespace mote::integrators {

using namespace core;

std::unique_ptr<Estimator> make_photon_map_estimator(const Scene& scene, const RenderOptions& options,
                                                     const PhotonMapSettings& settings) {
    if (scene.has_media()) return std::make_unique<PhotonMapEstimator<true>>(scene, options, settings);
    return std::make_unique<PhotonMapEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
