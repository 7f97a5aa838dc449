// Points in a scene's media with the light that they scatter, and the buffers that see them.
#pragma once

#include <optional>

#include "gathering/stored_light/arriving_fluence.h"
#include "gathering/stored_light/fog_radiosity.h"

namespace mote::gathering {

struct LitVolumeSettings {
    std::uint32_t points = 16384;
    float cut = 4.0f;         ///< FogBuffers
    std::uint32_t level = 4;  ///< of radiosity: one of 2^level points gathers for all of them
};

class LitVolume {
  public:
    /// Throws InputError where so many points, and the places that they are drawn from, exceed the budget
    /// [B].
    static void check_memory(std::uint32_t points, std::size_t budget);
    /// Points drawn for `key`. `surfaces` is kept by reference; its settings serve points, too. Throws
    /// core::Cancelled.
    LitVolume(const core::LitScene& scene, const PointHierarchy& surfaces, const MicroBuffers& hemispheres,
              const MicroBufferSettings& buffers, const LitVolumeSettings& settings,
              const MediumStateAt& state_at, std::uint64_t key, core::CancelToken cancelled);
    LitVolume(const LitVolume&) = delete;
    LitVolume& operator=(const LitVolume&) = delete;

    const VolumePoints& points() const { return points_; }
    const VolumeHierarchy& hierarchy() const { return hierarchy_; }
    /// What receivers on surfaces see, by HemisphereMap::cosine; and each half of what points see.
    const FogBuffers& hemispheres() const { return hemispheres_; }
    const FogBuffers& spheres() const { return spheres_; }
    /// By point. Precondition of light(): it was set.
    void set_light(std::span<const Fluence> fluence) { light_.emplace(hierarchy_, points_, fluence); }
    const VolumeLight& light() const { return *light_; }
    std::size_t memory_bytes() const;

  private:
    LitVolume(MediumSamples samples, const PointHierarchy& surfaces, const MicroBuffers& hemispheres,
              const MicroBufferSettings& buffers, const LitVolumeSettings& settings, std::uint64_t key);

    ExtinctionGrid extinction_;
    VolumePoints points_;
    VolumeHierarchy hierarchy_;
    MicroBuffers sphere_buffers_;
    FogBuffers hemispheres_, spheres_;
    std::optional<VolumeLight> light_;
};

}  // namespace mote::gathering
