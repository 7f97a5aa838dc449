// The mean extinction of a medium within a radius of a point, from a pyramid of averages.
//
// Approximate bias compensation treats the medium inside a bounding region as homogeneous, with the mean
// extinction there (Engelhardt 2013, Sec. 10.2). Level 0 holds the means of cubic cells, every further level
// those of eight cells of the one before. A lookup interpolates: a trilinear lookup in level l weights space
// with a variance of h_l^2 / 4 an axis (box and tent), a ball of radius r with r^2 / 5; two levels, or the
// medium itself and level 0, are mixed so that the variances agree. Filtered, that is, never a point sample,
// and exact wherever the extinction is linear.
// A ball that reaches beyond the medium gets at most what all of the medium would give it.
#pragma once

#include <vector>

#include "core/scene/medium.h"

namespace mote::media {

class MeanExtinction {
  public:
    static constexpr std::size_t default_bytes = std::size_t(64) << 20;

    /// Pyramid of `medium` inside `box`, vacuum beyond. Keeps a reference to the medium. Cells are as small
    /// as the medium's voxels where `max_bytes` allow, else larger. Homogeneous media take no memory.
    MeanExtinction(const core::Medium& medium, const core::Bounds3& box,
                   std::size_t max_bytes = default_bytes);

    /// Mean of sigma_t over the ball of `radius` [m] around p, per channel [1/m].
    core::Rgb mean(const core::Vec3& p, float radius) const;

    std::size_t memory_bytes() const;
    std::size_t levels() const { return levels_.size(); }
    /// Edge of the cells of level 0 [m].
    float cell_size() const { return cell_size_; }

  private:
    struct Level {
        glm::ivec3 size{0};
        float cell;                 ///< edge [m]
        std::vector<float> values;  ///< channels_ a cell, x fastest
    };
    void fill_finest(Level& level) const;
    Level coarser(const Level& fine) const;
    core::Rgb value(const Level& level, const glm::ivec3& cell) const;
    core::Rgb interpolate(const Level& level, const core::Vec3& p) const;
    core::Rgb unbounded_mean(const core::Vec3& p, float radius) const;

    const core::Medium& medium_;
    core::Bounds3 box_;
    core::Rgb constant_{0.0f};
    core::Rgb total_{0.0f};  ///< integral of sigma_t over the box [m^2]
    bool homogeneous_;
    int channels_;
    float cell_size_ = 0.0f;
    std::vector<Level> levels_;
};

}  // namespace mote::media
