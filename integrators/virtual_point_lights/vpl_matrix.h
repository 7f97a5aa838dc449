// Matrix row-column sampling in the passes of `mote_vpl`: receivers of a picture, from which rows are drawn,
// and the clusters of a pass.
#pragma once

#include <optional>

#include "core/render/statistics.h"
#include "core/scene/scene.h"
#include "integrators/eye_path/counters.h"
#include "integrators/eye_path/eye_ray.h"
#include "integrators/virtual_point_lights/vpl_selection.h"
#include "lights/selection/shared_columns.h"

namespace mote::integrators {

/// Pixels spread over a picture of `width` x `height`, one in each cell of a grid: about `count`, or all.
std::vector<glm::ivec2> spread_pixels(int width, int height, std::size_t count, std::uint64_t key);

/// So many eye paths look for receivers that every stratum of a slice has several to draw from.
std::size_t eye_paths_for(const lights::MatrixSettings& settings);

/// The receivers on the eye paths of these pixels, on surfaces and in media. `tile` is an EyeTile that
/// gathers nothing from then on; the paths are others than those of the pass.
template <typename Tile>
std::vector<lights::MatrixReceiver> find_receivers(const core::Scene& scene,
                                                   const core::RenderOptions& options,
                                                   const core::PassContext& pass,
                                                   std::span<const glm::ivec2> pixels, Tile& tile) {
    std::vector<lights::MatrixReceiver> receivers;
    tile.collect_receivers(receivers);
    core::RenderOptions own = options;
    own.seed = core::hash_keys(options.seed, 0x6d6174726978ull);
    constexpr std::size_t lanes = lights::ReceiverTile::width;
    for (std::size_t first = 0; first < pixels.size(); first += lanes) {
        if (pass.cancelled) break;
        for (std::size_t i = 0; i < lanes; ++i)
            if (first + i < pixels.size())
                tile.start(int(i), make_eye_ray(scene, own, pass, pixels[first + i].x, pixels[first + i].y));
            else
                tile.stop(int(i));
        tile.run({}, 1.0f);
    }
    return receivers;
}

class VplMatrix {
  public:
    VplMatrix(const core::Scene& scene, const lights::MatrixSettings& settings, std::uint64_t seed);

    /// The clusters at hand are those of the lights of this pass, or of none.
    std::optional<std::uint32_t> pass() const { return pass_; }
    /// Rows and clusters from the lights of a pass. Throws as MatrixSelection does.
    void make(std::uint32_t pass, const lights::VplSet& vpls,
              std::span<const lights::MatrixReceiver> receivers, float bound, std::uint64_t key,
              SharedCounters& counters, core::CancelToken cancelled);
    /// For the gathers of a pass that has these lights.
    void use_for(std::uint32_t pass, const lights::VplSet& vpls);
    const lights::MatrixSelection& selection() const { return other_ ? *other_ : shared_.found(); }
    void add_statistics(core::Statistics& statistics) const;

  private:
    const core::Scene& scene_;
    lights::MatrixSettings settings_;
    lights::SurfacePoints points_;  ///< of imperfect maps at rows
    std::optional<std::uint32_t> pass_;
    lights::SharedColumns shared_;
    std::optional<lights::MatrixSelection> other_;  ///< for lights of another pass
    std::uint64_t receivers_ = 0;
    double seconds_ = 0.0;
    std::size_t bytes_ = 0;
};

}  // namespace mote::integrators
