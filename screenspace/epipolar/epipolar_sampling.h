// One epipolar line: where rays are marched, and what lies between them.
//
// Texels stand a pixel apart or less. They fall into runs, within which the ends of the eye rays continue
// each other; a sample is marched at both ends of every run, that is before and after every discontinuity,
// and at a few texels evenly spread over the lit part of the line (Engelhardt 2013, Secs. 9.2.1, 9.2.2).
// Further than the paper: between two samples whose light or transmittance differs, the middle is marched
// too, until it agrees with what interpolation would give. All other texels are interpolated linearly.
#pragma once

#include <cmath>
#include <vector>

#include "screenspace/epipolar/epipolar_lines.h"
#include "screenspace/in_scattering/in_scattering_source.h"

namespace mote::screenspace {

/// Density of marched rays.
struct LineSampling {
    int initial = 16;  ///< samples spread over the lit part, at least 2
    int cap = 1024;  ///< samples of one line, at most: far above what shafts need, so that memory is bounded
    float tolerance =
        0.05f;  ///< of interpolation, as a fraction of the light there and in the mean; 0: no refinement
    /// Discontinuities of distance, as a fraction of it, see continues().
    float depth_tolerance = 0.02f;
    double texels = 1.0;  ///< a pixel along the line: where samples can be, and edges are found
    double shift = 0.0;   ///< of the spread samples, in [0, 1) of their distance
};

/// 24 bytes.
struct LineTexel {
    core::Rgb light{0.0f};  ///< radiance over RayEnd::weight
    float distance = 0.0f;  ///< RayEnd::distance
    std::int32_t run = -1;  ///< texels of one run continue each other; -1 where nothing is lit
    bool surface = false, known = false, marched = false;  ///< known: light is set; false beyond the cap
};

/// A ray that was marched.
struct LineSample {
    std::size_t texel;  ///< index in the line
    float weight;       ///< RayEnd::weight
    MarchedRay light;   ///< its radiance over that weight
};

/// A line with its texels.
class SampledLine {
  public:
    /// Finds the runs, and marches the samples that do not depend on light: run ends and evenly spread ones.
    SampledLine(const EpipolarLine& line, const LineSampling& settings, InScatteringTask& task);

    /// Refines where light or transmittance varies, and interpolates. `mean`: light averaged over the samples
    /// of all lines.
    void finish(const LineSampling& settings, float mean, InScatteringTask& task);

    const EpipolarLine& line() const { return line_; }                   ///< on the film
    const std::vector<LineTexel>& texels() const { return texels_; }     ///< from its start to its end
    const std::vector<LineSample>& samples() const { return samples_; }  ///< until finish()
    std::size_t marched() const { return marched_; }                     ///< rays
    /// Where a texel lies [pixels].
    Vec2d film(double texel) const;
    std::size_t memory_bytes() const;

  private:
    LineSample march_texel(std::size_t texel, InScatteringTask& task);
    void find_runs(float tolerance, InScatteringTask& task);
    std::vector<bool> spread(const LineSampling& settings) const;
    bool ends_run(std::size_t texel) const;
    void march(const LineSampling& settings, InScatteringTask& task);
    void refine(const LineSampling& settings, float mean, std::size_t from, std::size_t to,
                InScatteringTask& task, std::vector<LineSample>& added);
    void interpolate();

    EpipolarLine line_;
    std::vector<LineTexel> texels_;
    std::vector<LineSample> samples_;  ///< by texel, ascending; discarded by finish()
    std::size_t marched_ = 0;
};

}  // namespace mote::screenspace
