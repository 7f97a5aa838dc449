// Light scattered once along the first rays of a whole picture, for lights that are marched on epipolar lines
// or on a regular grid, and interpolated: the part of a pass that comes after its eye paths.
#pragma once

#include <memory>
#include <mutex>

#include "integrators/eye_path/image_loop.h"
#include "integrators/single_scattering/single_scattering_estimator.h"
#include "screenspace/epipolar/epipolar_picture.h"
#include "screenspace/in_scattering/in_scattering_rays.h"

namespace mote::integrators {

/// The numbers that all pixels of a pass share.
struct PassNumbers {
    core::Vec2 lens, lines, march, grid;
    PassNumbers(const core::RenderOptions& options, std::uint32_t pass);
};

/// A pixel's first ray, for interpolation: 24 bytes.
struct EyePoint {
    core::Vec2 film;
    screenspace::FirstSurface surface;
};

struct ScatteringCounts {
    std::uint64_t rays = 0, steps = 0, unoccluded = 0;  ///< of marched rays
    std::uint64_t candidates = 0, filled = 0, lines = 0,
                  texels = 0;  ///< of interpolation; pixels that are lit
    std::size_t bytes = 0;
};

class InterpolatedScattering {
  public:
    /// Keeps references to all of them. The settings must not request every pixel. Rays are counted in
    /// `counters`.
    InterpolatedScattering(const core::Scene& scene, const core::RenderOptions& options,
                           const ScatteringSettings& settings, SharedCounters& counters)
        : scene_(scene),
          options_(options),
          settings_(settings),
          loop_(scene, options, {.by_rows = true}),
          counters_(counters) {}

    /// To be filled by the eye paths of a pass, a point for every pixel.
    void set_point(std::size_t pixel, const EyePoint& point) { points_[pixel] = point; }
    void make_room() { points_.resize(std::size_t(options_.width) * std::size_t(options_.height)); }

    /// Adds the light of all lights to layer 2, and the marched rays to layer 3 where they are shown. Returns
    /// false when it was cancelled.
    bool run(const core::PassContext& context, const PassNumbers& numbers,
             std::span<const screenspace::InScattering> lights, core::PassImage& image);
    const ScatteringCounts& counts() const { return counts_; }
    /// Those of interpolation.
    void add_statistics(core::Statistics& statistics) const;

  private:
    using Lines = std::unique_ptr<screenspace::EpipolarPicture>;
    Lines find_lines(const PassNumbers& numbers, const screenspace::InScattering& light,
                     const screenspace::InScatteringRays& source,
                     const screenspace::EpipolarPicture::Loop& loop) const;
    bool scatter(const core::PassContext& context, const PassNumbers& numbers,
                 const screenspace::InScattering& light, core::PassImage& image);
    void show(const std::vector<screenspace::Vec2d>& places, core::PassImage& image) const;
    template <typename LightAt>
    bool upsample(const core::PassContext& context, const PassNumbers& numbers,
                  const screenspace::InScattering& light, const screenspace::InScatteringRays& source,
                  core::PassImage& image, const LightAt& light_at);
    screenspace::FilmRectangle frame() const;

    const core::Scene& scene_;
    const core::RenderOptions& options_;
    const ScatteringSettings& settings_;
    ImageLoop<true> loop_;
    SharedCounters& counters_;
    std::mutex mutex_;
    ScatteringCounts counts_;
    std::vector<EyePoint> points_;
};

}  // namespace mote::integrators
