// Light that surfaces behind others reflect, for screen-space compensation with several layers: a picture has
// none of it, so every pass gathers it as for what is seen, direct light and bounded virtual point lights.
//
// Points lie along the rays through pixel centres, on each side of each surface
// (screenspace/ssbc/ssbc_layers.h), and stay the same in all passes; their light is a layer of the film, so
// that means, checkpoints and resumed renders need nothing else. A step of the compensation takes the mean
// over many of them, so each need not meet all VPLs of a pass: those are shared out among points. Points that
// no step of the compensation can carry light from are left out, most of them where the bound reaches less
// far than surfaces lie apart.
#pragma once

#include <mutex>
#include <span>
#include <vector>

#include "core/render/integrator.h"
#include "core/scene/ray_walk.h"
#include "integrators/eye_path/counters.h"
#include "lights/virtual_lights/virtual_point_light.h"
#include "screenspace/ssbc/ssbc.h"

namespace mote::integrators {

struct ScreenSpaceSettings {
    screenspace::SsbcSettings ssbc;  ///< but for the bound, which is that of the render
    int layers = 1;                  ///< of surfaces along a ray; 1: what the picture shows
    int vpl_share = 4;               ///< at each hidden point: one VPL of so many, in turn
};

class HiddenLight {
  public:
    /// Keeps references to the scene. `max_depth`: edges of a path as seen from the eye, -1 no limit; `bound`
    /// is b [1/m^2].
    HiddenLight(const core::Scene& scene, const core::RenderOptions& options,
                const ScreenSpaceSettings& settings, int max_depth, float bound);

    bool any() const { return layers_ > 1; }
    /// Adds an estimate to the layers from `first_layer` on, one for each side. Returns false when cancelled.
    bool pass(const core::PassContext& context, const lights::VplSet& vpls, std::size_t first_layer,
              core::PassImage& image);

    void add_statistics(core::Statistics& statistics) const;

  private:
    struct Point {
        std::uint32_t pixel;
        std::uint32_t side;
    };
    template <bool Media>
    void gather(const core::PassContext& context, const lights::VplSet& vpls, std::size_t first_layer,
                std::span<const Point> points, core::PassImage& image);

    const core::Scene& scene_;
    core::RenderOptions options_;
    int layers_, max_depth_;
    std::uint32_t share_;
    float bound_;
    std::vector<Point> points_;  ///< pixel after pixel, neighbours together
    std::size_t candidates_ = 0;
    SharedCounters counters_;
    std::mutex mutex_;
    double seconds_ = 0.0;  ///< processor time, all threads
};

}  // namespace mote::integrators
