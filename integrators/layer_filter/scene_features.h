// The features of a view of a scene for the filter of layers (screenspace/layer_filter/filter_features.h).
//
// Every pixel has a few eye rays of its own, sampled through the scene's pixel filter and lens from keys that
// no render uses; media are marched once a pixel, along its first ray.
#pragma once

#include "core/render/integrator.h"
#include "core/scene/scene.h"
#include "screenspace/layer_filter/filter_features.h"
#include "screenspace/layer_filter/fine_pixels.h"

namespace mote::integrators {

struct FeatureSettings {
    int samples = 16;     ///< eye rays a pixel
    float voxels = 2.0f;  ///< step of the march through grids, in voxels
};

/// Size, seed and sampler are those of `options`. The same for any number of threads. Throws Cancelled.
screenspace::FilterFeatures find_filter_features(const core::Scene& scene, const core::RenderOptions& options,
                                                 const FeatureSettings& settings);

/// Features of quarters of pixels, by settings.samples / 4 eye rays each, one at least, and steps of twice
/// as many voxels.
screenspace::FineFeatures find_fine_features(const core::Scene& scene, const core::RenderOptions& options,
                                             const FeatureSettings& settings);

}  // namespace mote::integrators
