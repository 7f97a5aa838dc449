// Passes of paths that are none of the picture: a guide learns from some of them, others try it out.
//
// Their random numbers follow from seed, pass and path number alone, and their samples come in that order:
// the results do not depend on threads.
#pragma once

#include "integrators/eye_path/counters.h"
#include "integrators/path_tracing/trace_paths.h"
#include "lights/guiding/learned_guide.h"

namespace mote::integrators {

/// Paths of one pass.
struct TrainingPass {
    std::uint32_t index;   ///< of its random numbers
    std::uint32_t layout;  ///< paths are spread evenly over the image, in another way for every layout
    std::size_t paths;
};

/// Traces such passes. Throws Cancelled.
template <bool Media>
class TrainingPaths {
  public:
    /// Scene and settings must outlive it.
    TrainingPaths(const core::Scene& scene, const core::RenderOptions& options, const PathSettings& settings)
        : scene_(scene), options_(options), settings_(settings) {}

    /// Samples of all vertices, for a guide to learn from.
    lights::GuidingSamples record(const TrainingPass& pass, const lights::ScatteringGuide& guide,
                                  core::CancelToken cancelled, SharedCounters& counters) const;
    /// Light of each path, averaged over channels.
    std::vector<float> light(const TrainingPass& pass, const lights::ScatteringGuide& guide,
                             core::CancelToken cancelled, SharedCounters& counters) const;

  private:
    template <typename Trace>
    void trace(const TrainingPass& pass, const lights::ScatteringGuide& guide, core::CancelToken cancelled,
               SharedCounters& counters, const Trace& trace) const;
    EyeRay eye_ray(const core::PixelFilter& filter, const TrainingPass& pass, std::size_t path) const;

    const core::Scene& scene_;
    core::RenderOptions options_;
    const PathSettings& settings_;
};

}  // namespace mote::integrators
