// Paths of a picture without an estimator, for tests of what leads to its layers.
#pragma once

#include "integrators/eye_path/image_loop.h"
#include "integrators/path_tracing/trace_paths.h"

namespace mote::tests {

/// Traces a path through every pixel, whose number is a multiple of the packet's width: visit(pixel, sum).
template <bool Media, typename Visit>
void for_each_path(const core::Scene& scene, const integrators::PathSettings& settings,
                   const core::RenderOptions& options, const core::PassContext& context,
                   integrators::EyePacket<Media>& packet, const Visit& visit) {
    constexpr int width = integrators::EyePacket<Media>::width;
    for (int first = 0; first < options.width * options.height; first += width) {
        for (int i = 0; i < width; ++i)
            packet.start(i, integrators::make_eye_ray(scene, options, context, (first + i) % options.width,
                                                      (first + i) / options.width));
        integrators::trace_paths(scene, settings, packet);
        for (int i = 0; i < width; ++i) visit(first + i, packet[i].sum);
    }
}

}  // namespace mote::tests
