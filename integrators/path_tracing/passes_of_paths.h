// Passes of paths that are none of the picture: guides learn from some of them, others try guides out.
//
// Their random numbers follow from seed, pass and path number alone: results do not depend on threads.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

#include "core/render/render_driver.h"
#include "integrators/eye_path/counters.h"
#include "integrators/path_tracing/trace_paths.h"

namespace mote::integrators {

/// Paths of one pass.
struct PassOfPaths {
    std::uint32_t index;   ///< of its random numbers
    std::uint32_t layout;  ///< paths are spread evenly over the image, in another way for every layout
    std::size_t paths;     ///< their number

    static constexpr std::size_t chunk_paths = 1024;  ///< of a task, packet by packet
    std::size_t chunks() const { return (paths + chunk_paths - 1) / chunk_paths; }
};

/// The start of one of them.
EyeRay eye_ray(const core::Scene& scene, const core::RenderOptions& options, const core::PixelFilter& filter,
               const PassOfPaths& pass, std::size_t path);

/// Traces the paths in parallel; trace(chunk, first path, packet) follows those of a packet that were
/// started. Throws Cancelled.
template <bool Media, typename Trace>
void trace_pass(const core::Scene& scene, const core::RenderOptions& options, const PathSettings& settings,
                const PassOfPaths& pass, const lights::ScatteringGuide& guide, SharedCounters& counters,
                const Trace& trace) {
    const auto filter = core::make_pixel_filter("box", 0.5f, 0.5f);
    tbb::parallel_for(std::size_t(0), pass.chunks(), [&](std::size_t chunk) {
        core::WalkContext walk;
        walk.cancelled = options.cancelled, walk.all_boundaries = settings.equiangular != nullptr;
        const auto packet = std::make_unique<EyePacket<Media>>(
            scene, EyePacketSettings{.limits = settings.limits, .guide = guide}, walk);
        const std::size_t end = std::min(pass.paths, (chunk + 1) * PassOfPaths::chunk_paths);
        for (std::size_t first = chunk * PassOfPaths::chunk_paths; first < end;
             first += EyePacket<Media>::width) {
            for (int i = 0; i < EyePacket<Media>::width; ++i)
                if (const std::size_t path = first + std::size_t(i); path < end)
                    packet->start(i, eye_ray(scene, options, *filter, pass, path));
                else
                    packet->stop(i);
            trace(chunk, first, *packet);
        }
        counters.add(walk.rays, walk.tracking);
    });
}

}  // namespace mote::integrators
