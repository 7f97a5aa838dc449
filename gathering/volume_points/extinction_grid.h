// What media take from light, in cells of a box: for transmittances that need not be exact to the metre.
#pragma once

#include <vector>

#include "core/math/bounds.h"

namespace mote::gathering {

class ExtinctionGrid {
  public:
    /// A box without anything.
    ExtinctionGrid() = default;
    /// Cells along each side of the box, and the extinction in each [1/m], x fastest.
    ExtinctionGrid(const core::Bounds3& box, const glm::ivec3& size, std::vector<core::Rgb> extinction);

    const core::Bounds3& box() const { return box_; }
    bool empty() const { return extinction_.empty(); }
    /// Is it the same in all channels, everywhere?
    bool grey() const { return grey_; }
    /// In the cell that holds p; p beyond the box counts as on its border. Precondition: not empty().
    const core::Rgb& at(const core::Vec3& p) const {
        const glm::ivec3 cell = glm::clamp(glm::ivec3((p - box_.lower) * per_metre_), glm::ivec3(0), last_);
        return extinction_[(std::size_t(cell.z) * std::size_t(last_.y + 1) + std::size_t(cell.y)) *
                               std::size_t(last_.x + 1) +
                           std::size_t(cell.x)];
    }
    std::size_t memory_bytes() const { return extinction_.capacity() * sizeof(core::Rgb); }

  private:
    core::Bounds3 box_;
    glm::ivec3 last_{0};          ///< cell
    core::Vec3 per_metre_{0.0f};  ///< cells
    std::vector<core::Rgb> extinction_;
    bool grey_ = true;
};

}  // namespace mote::gathering
