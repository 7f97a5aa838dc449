// Light of surfaces denoised at twice the resolution of the picture, where edges of half a pixel are edges,
// and then put together by the picture's own filter.
//
// The network takes a pixel whose samples see several surfaces for noise; features of quarters show it what
// they are. Media have no such edges, and quarters more noise than pixels: for them it is worse.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/render/integrator.h"
#include "screenspace/denoising/oidn_library.h"

namespace mote::screenspace {

/// Features of the quarters of pixels, row by row.
struct FineFeatures {
    int width = 0, height = 0;         ///< twice those of the picture
    std::vector<core::Rgb> reflected;  ///< transmittance times albedo, mean of the samples
    std::vector<core::Vec3> normal;    ///< shading normal, unit; zero where nothing is hit
    bool sharp = true;                 ///< false: a lens leaves noise in the normals
};

/// The picture of `fine` by its filter: sum_q f(q) L(q) / sum_q f(q) over the quarters q, f at their middles.
/// Throws std::invalid_argument where the size is not twice width x height.
std::vector<core::Rgb> by_pixel_filter(int width, int height, std::span<const core::Rgb> fine,
                                       const core::PixelFilter& filter);

class FinePixels {
  public:
    /// Throws InputError, here and from denoised(), where the library fails.
    FinePixels(FineFeatures features, std::shared_ptr<const OidnLibrary> library,
               std::unique_ptr<core::PixelFilter> filter);
    /// The picture of light of surfaces, of which `fine` has the quarters. For one thread at a time.
    std::vector<core::Rgb> denoised(std::span<const core::Rgb> fine);
    /// Frees what denoised() keeps for the next picture.
    void release() { series_.reset(); }

  private:
    FineFeatures features_;
    std::shared_ptr<const OidnLibrary> library_;
    std::unique_ptr<core::PixelFilter> filter_;
    std::optional<OidnLibrary::Series> series_;
};

}  // namespace mote::screenspace
