// The light scattered into a whole picture, from epipolar lines.
//
// A pixel lies between two lines. Along each the light at its foot is taken where the end of the ray there
// continues the pixel's own; else taps further along the line, weighted by their distance, stand in; else the
// next line outwards (Engelhardt 2013, Sec. 9.2.3). Where both sides fail nothing is returned, and the caller
// marches the pixel's ray.
//
// Memory: 24 bytes a texel, by default a texel a pixel along every line; while lines are sampled, 32 bytes a
// marched ray more.
#pragma once

#include <functional>

#include "screenspace/epipolar/epipolar_sampling.h"

namespace mote::screenspace {

/// Counted work of a picture.
struct PictureCounts {
    std::uint64_t lines = 0, texels = 0, marched = 0;  ///< lines, their texels, rays marched
    std::size_t bytes = 0;                             ///< of memory, at most
};

/// The lines of a light over a picture, sampled.
class EpipolarPicture {
  public:
    /// Runs body(i) for i in [0, count), in parallel or not; every body is independent of the others.
    using Loop = std::function<void(int count, const std::function<void(int)>& body)>;

    /// Finds the lit runs of all lines, marches, refines and interpolates. Holds no lines if the loop was
    /// cancelled.
    EpipolarPicture(EpipolarLines lines, const LineSampling& settings, const InScatteringSource& source,
                    const Loop& loop);

    /// The light scattered into the ray through `film`, whose end is `end`.
    std::optional<core::Rgb> light_at(const Vec2d& film, const RayEnd& end, InScatteringTask& task) const;

    std::span<const SampledLine> sampled() const {
        return sampled_;
    }  ///< with their light, around the border
    /// Work done so far.
    PictureCounts counts() const;
    std::vector<Vec2d> marched_at() const;  ///< film positions of the marched rays

  private:
    struct Tap {
        core::Rgb light{0.0f};  ///< over RayEnd::weight
        float weight = 0.0f;    ///< 1 where the line continues the pixel's surface
        double distance = 0.0;  ///< of the line from the pixel [pixels]
    };
    std::optional<core::Rgb> texel_light(const SampledLine& line, double texel, const RayEnd& end,
                                         InScatteringTask& task) const;
    Tap tap(std::size_t line, const Vec2d& film, double spacing, const RayEnd& end,
            InScatteringTask& task) const;

    EpipolarLines lines_;
    LineSampling settings_;
    std::vector<SampledLine> sampled_;
};

}  // namespace mote::screenspace
