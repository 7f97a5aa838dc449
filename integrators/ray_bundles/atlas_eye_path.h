// One eye path that ends on the light of an atlas.
//
// Lambertian surfaces show what the atlas holds. All other surfaces sample a light and scatter on, until one
// is met that does.
#pragma once

#include "integrators/eye_path/eye_path.h"
#include "integrators/ray_bundles/atlas_view.h"

namespace mote::integrators {

struct AtlasEyeSettings {
    EyePathLimits limits;
    bool sample_direct = false;  ///< direct light of the first vertex is sampled, not looked up
    /// Lights that bundles do not carry; null: there are none.
    const core::LitScene* other_lights = nullptr;
};

class AtlasEyePath {
  public:
    AtlasEyePath(const core::Scene& scene, const AtlasEyeSettings& settings, const AtlasView& view,
                 core::WalkContext& context)
        : scene_(scene), settings_(settings), view_(view), context_(context) {}

    /// Radiance along the eye ray, by layer.
    TransportSum trace(const EyeRay& eye) {
        TransportSum sum;
        EyePath<false> path(scene_, settings_.limits, eye, context_);
        while (path.advance(context_, sum)) {
            const core::ScatteringVertex& vertex = path.vertex();
            if (!vertex.connectable()) continue;
            const auto reflectance = vertex.diffuse_reflectance();
            const auto light = reflectance ? view_.at(vertex) : std::nullopt;
            if (!light) {
                if (path.wants_connection()) sum[path.layer_of_connection()] += path.sample_light(context_);
                continue;
            }
            const core::Rgb weight = path.throughput() * *reflectance * core::inv_pi;
            sum[Transport::indirect] += weight * light->indirect;
            if (path.scatterings() > 0) {
                sum[Transport::indirect] += weight * (light->direct + light->sampled);
            } else if (settings_.sample_direct) {
                sum[Transport::direct] += path.sample_light(context_);
                path.advance(context_, sum);  // the other technique: what its direction meets
            } else {
                sum[Transport::direct] += weight * light->direct + other_lights(path);
            }
            break;
        }
        return sum;
    }

  private:
    core::Rgb other_lights(EyePath<false>& path) {
        if (!settings_.other_lights) return core::Rgb(0.0f);
        const float u = path.sampler().next_1d();
        return lights::sample_light<false>(*settings_.other_lights, path.vertex(), path.weights(), {}, u,
                                           path.sampler().next_2d(), context_);
    }

    const core::Scene& scene_;
    const AtlasEyeSettings& settings_;
    const AtlasView& view_;
    core::WalkContext& context_;
};

}  // namespace mote::integrators
