// Noise-free features for the filter of layers: the surface that a pixel sees, the fraction of its reflected
// light that reaches the eye, and the light that the media before it scatter.
//
// Only these decide which pixels may be averaged, never the noisy layer. A pixel whose samples see one
// surface is `single`; where they see several, a silhouette or an edge, it is `mixed` and keeps its samples,
// so that it can be put together from its neighbours (mixed_pixels.h). Buffers go row by row from the top.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::screenspace {

/// Features along one eye ray of a pixel.
struct FeatureSample {
    bool hit = false;         ///< a surface; all but `scattering` and `transmittance` are zero otherwise
    bool filterable = true;   ///< false: a mirror or glass, whose picture lies elsewhere
    float distance = 0.0f;    ///< along the ray [m]
    float transmittance = 1;  ///< from the eye to the surface, mean over channels
    core::Vec3 position{0.0f};
    core::Vec3 normal{0.0f}, shading_normal{0.0f};  ///< unit, towards the viewer
    core::Rgb reflected{0.0f};                      ///< transmittance times albedo
    core::Rgb scattering{0.0f};  ///< int T sigma_s dt up to the surface: fraction of light scattered there
};

/// Footprint of a pixel on its surface, for distances in pixels.
struct PixelFrame {
    core::Vec3 along_x{0.0f}, along_y{0.0f};  ///< pixels to the right and down per metre, tangential [1/m]
    float footprint = 0.0f;                   ///< of a pixel at the surface, across the ray [m]
};

enum class PixelKind : std::uint8_t {
    none,    ///< no surface, or none that can be filtered
    single,  ///< one surface
    mixed
};

struct FilterFeatures {
    int width = 0, height = 0;
    int samples_per_pixel = 0;  ///< of mixed pixels

    std::vector<PixelKind> kind;
    std::vector<core::Vec3> position;                ///< mean of the samples [m]
    std::vector<core::Vec3> normal, shading_normal;  ///< unit
    std::vector<float> distance;                     ///< mean along the ray [m]; `far` without a surface
    std::vector<float> transmittance;                ///< to the surface, mean over samples and channels
    std::vector<PixelFrame> frame;
    std::vector<core::Rgb> reflected, scattering;  ///< means of the samples: what layers are divided by

    /// Mixed pixels in ascending order, and their samples one pixel after the other.
    std::vector<std::uint32_t> mixed;
    std::vector<FeatureSample> samples;

    static constexpr float far = 1e18f;  ///< [m]; finite, so that differences are

    FilterFeatures() = default;
    /// Nothing is seen. Throws std::invalid_argument unless the sizes are positive.
    FilterFeatures(int width, int height, int samples_per_pixel);
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }

    /// Sets a pixel from its samples. Returns true if it is mixed; the caller then adds it to `mixed` and its
    /// samples to `samples`, in order.
    bool set_pixel(std::size_t pixel, std::span<const FeatureSample> samples, const PixelFrame& at);
};

/// The direction of a sum of normals; zero where they cancel or there are none.
core::Vec3 unit_or_zero(const core::Vec3& v);

/// The mean of the samples that hit: where a PixelFrame is to be found.
struct MeanSurface {
    core::Vec3 position{0.0f}, normal{0.0f};
    float distance = 0.0f;
    bool hit = false;
};
MeanSurface mean_surface(std::span<const FeatureSample> samples);

}  // namespace mote::screenspace
