// Fills the texels of a volumetric shadow map: one builder a thread.
#pragma once

#include "lights/shadow_maps/volumetric_shadow_map.h"
#include "media/heterogeneous_medium.h"

namespace mote::lights {

class ShadowMapBuilder {
  public:
    ShadowMapBuilder(const core::RayQueries& scene, const VolumetricShadowMap& map,
                     const core::MediumState& at_light);

    /// Traces and marches one texel's ray and writes its piece of memory.
    void fill(int texel, std::byte* record);
    const core::RayCounters& rays() const { return rays_; }

  private:
    /// What marching needs to know of a medium, asked once.
    struct MarchedMedium {
        const core::Medium* medium;
        const media::HeterogeneousMedium* grid;  ///< null: homogeneous
        core::Bounds3 bounds;
    };
    /// One medium along a part of the ray.
    struct Segment {
        const MarchedMedium* medium;
        float begin, end;
    };
    struct Node {
        float distance;
        core::Rgb depth;
    };

    float find_surface(const core::Ray& ray, VolumetricShadowMap::Header& header);
    void find_segments(const core::Ray& ray, float end);
    void march(const core::Ray& ray, const VolumetricShadowMap::Header& header, float step);
    void march_segments(const core::Ray& ray, float enter, float step);
    float step_of(const MarchedMedium& medium, float length) const;
    core::Vec3d depth_of(const Segment& segment, const core::Ray& part);
    void keep_nodes(std::size_t count);
    void write(std::byte* record) const;
    static float loss(const Node& a, const Node& b, const Node& c);

    const core::RayQueries& scene_;
    const VolumetricShadowMap& map_;
    const core::MediumState& at_light_;
    std::vector<MarchedMedium> media_;
    core::RayCounters rays_;
    core::TrackingCounters counters_;
    std::vector<core::SurfaceHit> boundaries_;
    std::vector<Segment> segments_;
    std::vector<core::Vec3d> depths_;
    std::vector<Node> nodes_;  ///< at the ends of all intervals, or what is left of them
};

}  // namespace mote::lights
