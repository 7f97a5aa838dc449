// The rival of epipolar sampling: a regular grid of marched rays, and bilateral upsampling between them.
//
// Used for a light at the eye too, whose epipolar lines are points (Engelhardt 2013, Sec. 9.2.1). Memory: 84
// bytes a marched ray.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "screenspace/epipolar/epipolar_lines.h"
#include "screenspace/in_scattering/in_scattering_source.h"

namespace mote::screenspace {

class InScatteringGrid {
  public:
    using Loop = std::function<void(int count, const std::function<void(int)>& body)>;

    /// Rays `spacing` pixels apart, shifted by the fraction `shift` in [0, 1)^2 of it; the grid covers the
    /// frame.
    InScatteringGrid(const FilmRectangle& frame, double spacing, const Vec2d& shift, float depth_tolerance,
                     const InScatteringSource& source, const Loop& loop);

    /// The light scattered into the ray through `film`, from the four samples around it, or else from the
    /// sixteen, that continue its surface. Nothing where there is none.
    std::optional<core::Rgb> light_at(const Vec2d& film, const RayEnd& end) const;

    std::uint64_t marched() const { return marched_; }
    /// Where rays were marched.
    std::vector<Vec2d> marched_at() const;
    std::size_t memory_bytes() const { return samples_.capacity() * sizeof(Sample); }

  private:
    struct Sample {
        core::Ray ray;
        RayEnd end;
        core::Rgb light;  ///< radiance over end.weight
    };
    Vec2d film(int column, int row) const {
        return glm::clamp(origin_ + spacing_ * Vec2d(column, row), frame_.lower, frame_.upper);
    }
    std::optional<core::Rgb> weighted(const Vec2d& cell, const RayEnd& end, int reach) const;

    FilmRectangle frame_;
    Vec2d origin_;
    double spacing_;
    float depth_tolerance_;
    int columns_, rows_;
    std::vector<Sample> samples_;
    std::uint64_t marched_ = 0;
};

}  // namespace mote::screenspace
