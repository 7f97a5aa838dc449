// One walk along the ray: media change where it crosses a surface that holds one, and at boundaries between.
#include "gathering/ray_bundles/link_transmittance.h"

#include "core/scene/media_along.h"

namespace mote::gathering {

using namespace core;

void LinkTransmittance::along(const RayBundle& bundle, std::size_t ray, Rng& rng, TrackingCounters& counters,
                              std::span<Rgb> between) const {
    const auto hits = bundle.hits_of(ray);
    const BundleGrid& grid = bundle.grid;
    Ray leg{grid.ray_origin(std::uint32_t(ray % grid.columns), std::uint32_t(ray / grid.columns)),
            grid.direction};
    MediumState state;
    state.set_outside(outermost_);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        // Up to this hit, from the one before or, for the media alone, from outside.
        leg.t_min = i > 0 ? hits[i - 1].distance : 0.0f, leg.t_max = hits[i].distance;
        Rgb transmittance(1.0f);
        const auto part = [&](float t0, float t1, const MediumState& here) {
            if (i > 0 && here.current() && t0 < t1 && !is_black(transmittance))
                transmittance *=
                    here.current()->transmittance(Ray{leg.origin, leg.direction, t0, t1}, rng, counters);
            return true;
        };
        const auto pane = [&](const SurfaceHit& hit) {
            transmittance *= passage_through(hit, leg.direction).transmittance();
            return true;
        };
        state = *for_each_part(scene_, leg, state, part, pane);
        if (i > 0) between[i - 1] = transmittance;
        const Vec3 outside = hits[i].from_behind() ? leg.direction : -leg.direction;
        state.cross(*shapes_[triangles_.shape[hits[i].index()]], outside, leg.direction);
    }
}

}  // namespace mote::gathering
