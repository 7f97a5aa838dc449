// The light of virtual point lights at tiles of pixels sampled from an image, by any selection.
// All have the same VPLs, the same eye paths and the same points along them.
#pragma once

#include <ctime>

#include "core/render/render_driver.h"
#include "integrators/virtual_point_lights/vpl_gatherer.h"

namespace mote::studies {

using namespace integrators;

struct Arguments {
    std::string scene, references, pixels;
    std::vector<std::string> methods;
    std::uint32_t paths = 1000, tiles = 60, threads = 1;
    int width = 512, height = 512, points = 2;
    float bound = 1.0f;
    bool costs_only = false;
};

/// Processor time of this thread, or of all.
double now(clockid_t clock);

/// "all", "lightcuts:THRESHOLD:MAX_CUT:ERROR:ANGLE" and "multidimensional:..." alike, where
/// numbers left out have their defaults, "uniform:N", "stochastic:N", "tree:N", "ris:CANDIDATES:SAMPLES",
/// "matrix:ROWS:COLUMNS:SLICES:rays|shadow_map".
std::shared_ptr<const lights::Selection> selection_of(const std::string& text);

/// The light of VPLs at the sixteen pixels of a tile.
using Pixels = std::array<double, 16>;

/// Costs of tiles.
struct TileCost {
    int tiles = 0;
    double seconds = 0.0;  ///< of gathering, with eye paths and direct light, which are the same for all
    double rays = 0.0;
    core::Statistics selection;
};

class Study {
  public:
    explicit Study(const Arguments& a);

    /// A selection for the VPLs of the study.
    struct Method {
        std::shared_ptr<const lights::Selection> selection;
        lights::VplSelector selector;
        bool learns;  ///< from the tiles before
    };
    Method prepare(const std::string& text) const;

    std::size_t tiles() const { return tiles_.size(); }
    glm::ivec2 tile(std::size_t index) const { return tiles_[index]; }  ///< its first pixel
    std::size_t lights() const { return vpls_.lights.size(); }
    /// The light at a tile. Selectors learn from the tiles before, so all of the sixteen tiles of a task of
    /// the renderer are lit by them. Safe from many threads.
    Pixels render(std::size_t tile, const Method& method, TileCost& cost) const;

    double tracing = 0.0;  ///< seconds of the processor

  private:
    Arguments arguments_;
    std::unique_ptr<core::Scene> scene_;
    core::RenderOptions options_;
    VplSettings settings_;
    lights::VplSet vpls_;
    std::unique_ptr<core::PixelFilter> filter_ = core::make_pixel_filter("box", 0.5f, 0.5f);
    std::vector<glm::ivec2> tiles_;
};

}  // namespace mote::studies
