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

/// How densely rays are marched.
struct LineSampling {
    int initial = 16;  ///< samples spread over the lit part, at least 2
    int cap = 1024;    ///< samples of one line, at most
    float tolerance =
        0.05f;  ///< of interpolation, as a share of the light there and in the mean; 0: no refinement
    float depth_tolerance = 0.02f;  ///< discontinuities of distance, see continues()
    double texels = 1.0;            ///< a pixel along the line: where samples can be, and edges are found
    double shift = 0.0;             ///< of the spread samples, in [0, 1) of their distance
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
    float texel;       ///< whole, but where a line of another light crosses (epipolar_crossings.h)
    float weight;      ///< RayEnd::weight
    MarchedRay light;  ///< its radiance over that weight
};

/// A line with its texels.
class SampledLine {
  public:
    /// Finds the runs, and where spread samples are wanted.
    SampledLine(const EpipolarLine& line, const LineSampling& settings, InScatteringTask& task);

    /// `count` places at first + i * spacing, in texels; not all of them need be lit.
    struct Spread {
        double first = 0.0, spacing = 1.0;                         ///< [texels]
        int count = 0;                                             ///< of places
        double place(int i) const { return first + i * spacing; }  ///< of the i-th [texels]
        /// The place nearest to a texel.
        int nearest(double texel) const { return int(std::lround((texel - first) / spacing)); }
    };
    const Spread& spread() const { return spread_; }  ///< the evenly spread samples
    /// Is this place between texels of one run, or on one?
    bool lit(double texel) const;
    /// Is this texel the first of its run, or the last? It is marched then, spread sample or not.
    bool ends_run(std::ptrdiff_t texel) const;
    /// A ray that was marched at a lit place; it stands for the spread sample nearest to it.
    void add(double texel, const RayEnd& end, const MarchedRay& light);
    /// Places and marches the samples that do not depend on light: run ends, and the spread ones that were
    /// not added.
    void march(const LineSampling& settings, InScatteringTask& task);
    /// Refines where light or transmittance varies, and interpolates. `mean`: of the light over all lines'
    /// samples.
    void finish(const LineSampling& settings, float mean, InScatteringTask& task);

    const EpipolarLine& line() const { return line_; }                   ///< on the film
    const std::vector<LineTexel>& texels() const { return texels_; }     ///< from its start to its end
    const std::vector<LineSample>& samples() const { return samples_; }  ///< until finish()
    std::size_t marched() const { return marched_; }                     ///< rays
    /// Where a texel lies [pixels].
    Vec2d film(double texel) const;
    std::size_t memory_bytes() const;

  private:
    LineSample march_texel(float texel, InScatteringTask& task);
    void find_runs(float tolerance, InScatteringTask& task);
    void find_spread(const LineSampling& settings);
    void sort_samples();
    void place(const LineSampling& settings);
    void refine(const LineSampling& settings, float mean, std::size_t from, std::size_t to,
                InScatteringTask& task, std::vector<LineSample>& added);
    void interpolate();

    LineTexel& at(float texel) { return texels_[std::size_t(std::lround(texel))]; }

    EpipolarLine line_;
    Spread spread_;
    std::vector<LineTexel> texels_;
    std::vector<LineSample> samples_;  ///< by texel, ascending; thrown away by finish()
    std::size_t marched_ = 0;
};

}  // namespace mote::screenspace
