// Volumetric shadow maps: the transmittance from a light to everything, per direction as a function of
// distance (Salvi et al. 2010, as used in Engelhardt 2013, Sec. 10.3).
//
// A texel holds the optical depth along its ray between the points where the ray enters the media and where
// it leaves them, or a little behind the first surface, at fixed intervals, in 16 bits a value and one piece
// of memory with all else that a lookup needs. Optical depth is interpolated, not transmittance: between four
// rays that is a fifth more accurate (docs/methods/shadow_maps.md). A surface is kept as the plane through
// the point that the ray met, so that walls seen at grazing angles do not shadow themselves.
//
// Maps are deterministic and biased: by the march's step, by the intervals, and most of all by what lies
// between their rays. Transmittance is exactly 1 at the light, never rises along a ray, and is 0 behind the
// first surface and below e^-31.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/ray_counters.h"
#include "core/objects/cancellation.h"
#include "core/objects/memory_budget.h"
#include "core/scene/ray_queries.h"
#include "lights/shadow_maps/shadow_map_cells.h"

namespace mote::lights {

/// Settings of a map.
struct ShadowMapSettings {
    int intervals = 35;                            ///< between entry and exit (35 fill 96 bytes)
    float step = 1.0f;                             ///< of ray marching, in voxels of the medium
    std::size_t max_bytes = std::size_t(1) << 30;  ///< of one map

    /// Bytes of a map of `size`^2 texels.
    std::size_t bytes(int size, bool chromatic) const;
    /// Throws InputError when a map would exceed max_bytes, with the largest size that would not.
    void check(int size, bool chromatic) const;

    /// Numbers a texel and channel.
    std::size_t values() const { return std::size_t(intervals) + 1; }
};

/// True where maps of this scene need three channels.
bool needs_chromatic_maps(const core::RayQueries& scene);

/// Throws OutOfMemory where so many maps of `size`^2 texels exceed the budget, with the size that does not.
void require_shadow_maps(const core::MemoryBudget& memory, const ShadowMapSettings& settings,
                         std::size_t maps, int size, bool chromatic);

/// Sixteen points, and the transmittance per channel from the light to each.
struct alignas(64) ShadowLookup {
    static constexpr int width = 16;     ///< points
    float x[width], y[width], z[width];  ///< [m]
    float r[width], g[width], b[width];  ///< transmittance per channel, [0, 1]
};

/// The map of one light.
class VolumetricShadowMap {
  public:
    /// Traces and marches all texels in parallel; takes memory only when it grows. `at_light` holds the media
    /// at the light (parallel light: outside). Throws InputError when the map would be larger than
    /// settings.max_bytes, and core::Cancelled.
    void build(const core::RayQueries& scene, const ShadowMapView& view, const core::MediumState& at_light,
               const ShadowMapSettings& settings, core::CancelToken cancelled = {});

    /// From the light to the points, interpolated between the four texels around each; 0 where the map does
    /// not reach. Points within about a texel behind a surface count as on it. Many packets in one call hide
    /// the time that memory takes.
    void look_up(std::span<ShadowLookup> packets) const;
    /// Lookup of one point.
    core::Rgb transmittance(const core::Vec3& p) const;

    const ShadowMapView& view() const { return view_; }                               ///< of the last build
    std::size_t memory_bytes() const { return records_.capacity() * sizeof(Block); }  ///< of the texels
    const core::RayCounters& rays() const { return rays_; }                           ///< of the last build

    /// Beginning of a texel's memory. After it follow the values of all channels one after the
    /// other.
    struct Header {
        float enter, inverse_step;  ///< values are at enter + k / inverse_step
        /// Points with plane . p <= limit, in the frame of the view, lie before the surface.
        float plane_x, plane_y, plane_z, limit;
    };
    /// Optical depth of one step of the stored numbers. All 16 bits reach 32, where nothing is left.
    static constexpr float depth_unit = 1.0f / 2048.0f;

  private:
    friend class ShadowMapBuilder;
    struct alignas(32) Block {
        std::byte bytes[32];
    };
    std::byte* record(std::size_t index) { return records_[index * blocks_].bytes; }
    const std::byte* record(std::size_t index) const { return records_[index * blocks_].bytes; }
    template <int N>
    void look_up(const ShadowMapCells<N>& cells, float* r, float* g, float* b) const;
    void prefetch(const ShadowMapCells<ShadowLookup::width>& cells) const;
    void copy_border();

    ShadowMapView view_;
    ShadowMapSettings settings_;
    std::size_t channels_ = 1;
    std::size_t blocks_ = 0;  ///< of one texel
    std::vector<Block> records_;
    core::RayCounters rays_;
};

}  // namespace mote::lights
