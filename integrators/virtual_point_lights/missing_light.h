// Light that virtual point lights leave out: what the bound on the geometry term takes, and what reaches a
// receiver through mirrors and glass. For the error of the picture (core/metrics/group_error.h).
//
// Paths of their own estimate it, one a pixel and pass, with random numbers of their own: so it is
// independent of the picture, and from pixel to pixel.
#pragma once

#include "integrators/eye_path/image_loop.h"
#include "integrators/path_tracing/trace_paths.h"

namespace mote::integrators {

template <bool Media>
class MissingLight {
  public:
    /// `bound`: b [1/m^2]; infinity: mirrors and glass alone. The scene must outlive it.
    MissingLight(const core::Scene& scene, const core::RenderOptions& options, const EyePathLimits& limits,
                 float bound)
        : scene_(scene),
          options_(with_own_numbers(options)),
          paths_{.limits = limits, .bound = bound, .taken = true},
          loop_(scene, options_),
          light_(options.width, options.height, transport_layer_count(Media)) {
        paths_.limits.max_scatterings = -1;
        paths_.limits.wanted =
            TransportSet(Transport::indirect) | TransportSet(Transport::multiple_scattering);
    }

    /// Fills a layer of the image. Returns false when cancelled.
    bool pass(const core::PassContext& context, core::PassImage& image, std::size_t layer) {
        light_.clear();
        const bool complete =
            loop_.run(context, light_, {.limits = paths_.limits}, [&](EyeTask<Media>& task) {
                task.for_each([&](const PacketPixels&) { trace_paths(scene_, paths_, task.packet()); });
            });
        for (std::size_t from = 0; complete && from < light_.layers(); ++from)
            for (std::size_t p = 0; p < light_.layer(from).size(); ++p)
                image.layer(layer)[p] += light_.layer(from)[p];
        return complete;
    }
    /// Rays and lookups.
    void add_statistics(core::Statistics& statistics) const { loop_.add_statistics(statistics); }

  private:
    static core::RenderOptions with_own_numbers(core::RenderOptions options) {
        options.seed = core::hash_keys(options.seed, 0x6d697373696e67ull);
        return options;
    }

    const core::Scene& scene_;
    core::RenderOptions options_;
    PathSettings paths_;
    ImageLoop<Media> loop_;
    core::PassImage light_;  ///< of a pass, by cells
};

}  // namespace mote::integrators
