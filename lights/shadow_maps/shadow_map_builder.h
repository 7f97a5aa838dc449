// Fills the texels of a volumetric shadow map: one builder a thread.
#pragma once

#include "lights/shadow_maps/volumetric_shadow_map.h"

namespace mote::lights {

class ShadowMapBuilder {
  public:
    ShadowMapBuilder(const core::RayQueries& scene, const VolumetricShadowMap& map,
                     const core::MediumState& at_light);

    /// Traces and marches one texel's ray and writes its piece of memory.
    void fill(int texel, std::byte* record);
    const core::RayCounters& rays() const { return rays_; }

  private:
    /// A medium and where it is, found once.
    struct BoundedMedium {
        const core::Medium* medium;
        core::Bounds3 bounds;
    };
    /// One medium along a part of the ray.
    struct Segment {
        const core::Medium* medium;
        float begin, end;
    };
    /// Optical depth of a pane across the ray: spread over one interval, as everything between two values is.
    struct Pane {
        float distance;
        core::Vec3d depth;
    };

    float find_surface(const core::Ray& ray, VolumetricShadowMap::Header& header);
    void find_segments(const core::Ray& ray, float end);
    void march(const core::Ray& ray, const VolumetricShadowMap::Header& header, float step);
    core::Interval extent(float spacing) const;
    void march_segments(const core::Ray& ray, float enter, float step);
    void write(std::byte* record) const;

    const core::RayQueries& scene_;
    const VolumetricShadowMap& map_;
    const core::MediumState& at_light_;
    std::vector<BoundedMedium> media_;
    core::RayCounters rays_;
    core::TrackingCounters counters_;
    std::vector<Segment> segments_;
    std::vector<Pane> panes_;
    std::vector<core::Vec3d> depths_;  ///< at the ends of all intervals
};

}  // namespace mote::lights
