// Optical depths around a receiver, in a few directions to a few distances: what volumetric shadow maps are
// to lights.
#pragma once

#include <algorithm>

#include "gathering/micro_buffers/micro_buffers.h"
#include "gathering/volume_points/extinction_grid.h"

namespace mote::gathering {

class ReceiverDepths {
  public:
    /// In the direction of every texel, or of groups of them: at most 16 x 16 directions over the hemisphere.
    /// Keeps a reference to the grid.
    ReceiverDepths(const ExtinctionGrid& grid, HemisphereMap map, std::uint32_t side);

    /// By 24 equal steps of every ray through the box.
    void march(const MicroReceiver& receiver);
    /// Transmittance to a distance [m] in the direction of texel (x, y) of `side`^2.
    core::Rgb transmittance(std::uint32_t x, std::uint32_t y, float distance) const {
        if (grid_.empty()) return core::Rgb(1.0f);
        const std::size_t ray = std::size_t(y * across_ / side_) * across_ + x * across_ / side_;
        const float at =
            std::clamp((std::min(distance, 1e30f) - begin_[ray]) * per_metre_[ray], 0.0f, float(steps));
        const auto step = std::min(std::uint32_t(at), steps - 1);
        const core::Rgb* depths = depths_.data() + ray * (steps + 1) + step;
        const core::Rgb depth = depths[0] + (at - float(step)) * (depths[1] - depths[0]);
        return grid_.grey() ? core::Rgb(std::exp(-depth.x)) : glm::exp(-depth);
    }

  private:
    static constexpr std::uint32_t steps = 24, largest_side = 16;

    const ExtinctionGrid& grid_;
    std::uint32_t side_, across_;
    std::vector<core::Vec3> directions_;    ///< local
    std::vector<float> begin_, per_metre_;  ///< by ray: where it enters the box [m], and steps
    std::vector<core::Rgb> depths_;         ///< by ray, at the begin of each step and the end of the last
};

}  // namespace mote::gathering
