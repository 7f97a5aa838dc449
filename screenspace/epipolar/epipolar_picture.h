// The light scattered into a whole picture, from epipolar lines.
//
// A pixel lies between two lines. Along each the light at its foot is taken where the end of the ray there
// continues the pixel's own; else taps further along the line, weighted by their distance, stand in; else the
// next line outwards (Engelhardt 2013, Sec. 9.2.3). Where both sides fail nothing is returned, and the caller
// marches the pixel's ray. Further than the paper, so it is where the texels around the pixel differ by more
// than the light there and in the mean: neighbours a pixel apart cannot be refined, and a voxel much brighter
// than all around it would light the pixels beside it.
//
// Memory: 24 bytes a texel, by default a texel a pixel along every line; while lines are sampled, 32 bytes a
// marched ray more.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>

#include "screenspace/epipolar/epipolar_sampling.h"

namespace mote::screenspace {

/// Counted work of a picture.
struct PictureCounts {
    std::uint64_t lines = 0, texels = 0, marched = 0;  ///< lines, their texels, rays marched
    std::size_t bytes = 0;                             ///< of memory, at most
};

/// The darkest and the brightest of some texels.
struct LightRange {
    float darkest = std::numeric_limits<float>::infinity(), brightest = 0.0f;
    void add(float light) { darkest = std::min(darkest, light), brightest = std::max(brightest, light); }
    void add(const LightRange& o) { add(o.darkest), add(o.brightest); }
    /// True if they differ by more than their middle and than `mean`.
    bool is_edge(float weight, float mean) const {
        return weight * (brightest - darkest) > std::max(mean, 0.5f * weight * (darkest + brightest));
    }
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
    /// Light over RayEnd::weight, and the range of the texels that it is from.
    struct TexelLight {
        core::Rgb light{0.0f};
        LightRange range;
    };
    struct Tap {
        TexelLight at;
        float weight = 0.0f;    ///< 1 where the line continues the pixel's surface
        double distance = 0.0;  ///< of the line from the pixel [pixels]
    };
    std::optional<TexelLight> texel_light(const SampledLine& line, double texel, const RayEnd& end,
                                          InScatteringTask& task) const;
    Tap tap(std::size_t line, const Vec2d& film, double spacing, const RayEnd& end,
            InScatteringTask& task) const;

    EpipolarLines lines_;
    LineSampling settings_;
    std::vector<SampledLine> sampled_;
    float mean_ = 0.0f;  ///< light averaged over the samples of all lines
};

}  // namespace mote::screenspace
