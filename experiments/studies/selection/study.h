// The light of virtual point lights at tiles of pixels drawn from a picture, by any way of selecting them.
// All have the same VPLs, the same eye paths and the same points along them.
#pragma once

#include <ctime>

#include "core/render/render_driver.h"
#include "integrators/virtual_point_lights/vpl_eye_tile.h"
#include "integrators/virtual_point_lights/vpl_matrix.h"
#include "lights/selection/vertex_bounds.h"

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

/// "all", "lightcuts:THRESHOLD:MAX_CUT:ERROR:ANGLE:ANGLE_IN_MEDIA" and "multidimensional:..." alike, where
/// what is left out at the end is 0, "stochastic:N", "tree:N",
/// "ris:CANDIDATES:SAMPLES:none|unbiased|biased:groups|cut|tree|power",
/// "matrix:ROWS:COLUMNS:SLICES:rays|maps|imperfect".
SelectionSettings settings_of(const std::string& text);

/// The light of VPLs at the sixteen pixels of a tile.
using Pixels = std::array<double, 16>;

/// What tiles cost.
struct TileCost {
    int tiles = 0;
    double seconds = 0.0;  ///< of gathering, with eye paths and direct light, which are the same for all
    double rays = 0.0;
    lights::LightcutCounters cuts;
};

class Study {
  public:
    explicit Study(const Arguments& a);

    std::size_t tiles() const { return tiles_.size(); }
    glm::ivec2 tile(std::size_t index) const { return tiles_[index]; }  ///< its first pixel
    std::size_t lights() const { return hierarchy_->size(); }
    double bytes_a_light(bool drawn) const;  ///< with the tree, or with the hierarchy
    /// Rows and columns of a matrix, from all of the picture; null for other selections.
    std::unique_ptr<VplMatrix> prepare(const SelectionSettings& selection) const;
    /// The light at a tile. Cuts learn from the tiles before them, and others reuse what these have chosen,
    /// so all of the sixteen tiles that a task of the renderer has are lit by them. Safe from many threads.
    Pixels render(std::size_t tile, const SelectionSettings& selection, TileCost& cost,
                  const VplMatrix* matrix = nullptr) const;

    double tracing = 0.0, building = 0.0, planting = 0.0;  ///< seconds of the processor

  private:
    Arguments arguments_;
    std::unique_ptr<core::Scene> scene_;
    core::RenderOptions options_;
    VplSettings settings_;
    lights::VplSet vpls_;
    std::optional<lights::VplLeaves> leaves_;
    std::optional<lights::LightHierarchy> hierarchy_;
    std::optional<lights::LightTree> tree_;
    std::optional<lights::PowerCandidates> power_;
    std::unique_ptr<core::PixelFilter> filter_ = core::make_pixel_filter("box", 0.5f, 0.5f);
    std::vector<glm::ivec2> tiles_;
};

}  // namespace mote::studies
