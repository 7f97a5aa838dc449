// Volumetric shadow maps: the transmittance from a light to everything, per direction as a function of
// distance (Salvi et al. 2010, as used in Engelhardt 2013, Sec. 10.3).
//
// Every texel holds the transmittance along its ray between the points where the ray enters the media and
// where it leaves them or meets a surface. Two forms: values at fixed intervals, found at once; and nodes of
// a piecewise-linear function, of which those were dropped whose loss changed its integral least. Values come
// from ray marching, so a map is deterministic and biased: by its step, by its intervals, and by what lies
// between its rays. They never rise with distance, are exactly 1 at the light, and 0 behind the first
// surface.
#pragma once

#include <memory>
#include <vector>

#include "core/render/statistics.h"
#include "core/scene/scene.h"
#include "lights/shadow_map_view.h"

namespace mote::lights {

struct ShadowMapSettings {
    enum class Storage : std::uint8_t { intervals, nodes };
    Storage storage = Storage::intervals;
    int intervals = 64;  ///< between entry and exit; nodes are chosen from as many
    int nodes = 12;      ///< kept in each texel
    float step = 1.0f;   ///< of ray marching, in voxels of the medium
    std::size_t max_bytes = std::size_t(1) << 30;

    /// Bytes of a map of `size`^2 texels.
    std::size_t bytes(int size, bool chromatic) const;
    /// Throws InputError when a map would exceed max_bytes, with the largest size that would not.
    void check(int size, bool chromatic) const;
};

class VolumetricShadowMap {
  public:
    /// Traces and marches all texels in parallel; takes memory only when it grows. `at_light` holds the media
    /// at the light (parallel light: outside). Throws InputError when the map would be larger than
    /// settings.max_bytes.
    void build(const core::Scene& scene, const ShadowMapView& view, const core::MediumState& at_light,
               const ShadowMapSettings& settings);

    /// From the light to p per channel, interpolated between the four texels around it; 0 where the map does
    /// not reach. Points within about a texel behind a surface count as on it.
    core::Rgb transmittance(const core::Vec3& p) const;

    const ShadowMapView& view() const { return view_; }
    std::size_t memory_bytes() const;
    const core::RayCounters& rays() const { return rays_; }  ///< of the last build

  private:
    struct Texel {
        float enter, step;  ///< values are at enter + k * step
        float surface;      ///< distance of the first surface, or infinity
    };
    class Builder;
    core::Rgb at_intervals(std::size_t texel, float distance) const;
    core::Rgb at_nodes(std::size_t texel, float distance) const;
    core::Rgb value(std::size_t index) const {
        const float* v = values_.data() + index * std::size_t(channels_);
        return channels_ == 1 ? core::Rgb(v[0]) : core::Rgb(v[0], v[1], v[2]);
    }

    ShadowMapView view_;
    ShadowMapSettings settings_;
    int channels_ = 1;
    float slack_ = 0.0f;  ///< of the surface's distance, relative
    std::vector<Texel> texels_;
    std::vector<float> values_;     ///< intervals + 1, or nodes, a texel
    std::vector<float> distances_;  ///< of nodes
    core::RayCounters rays_;
};

}  // namespace mote::lights
