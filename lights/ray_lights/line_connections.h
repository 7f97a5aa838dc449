// Unoccluded light of a light at a receiver, where one of the two or both are
// lines: an eye ray through a medium, a ray light.
//
// Points on the lines are sampled (line_sampling.h), the values are divided by their densities: estimates of
//   eye ray, ray light    integral over v and u of  T sigma_s f_p(x)  V* / w^2  f_p(y) sigma_s T P
//   point, ray light      integral over u of        f*(x)    min(G*, b) V*    f_p(y) sigma_s T P
//   eye ray, surface VPL  integral over v of        T sigma_s f_p(x)  V* C*(y) / w^2  I
// without visibility and transmittance between x and y (Novak et al. 2012, Eqs. 5 to 8).
#pragma once

#include "lights/ray_lights/ray_light.h"
#include "lights/virtual_lights/vpl_receivers.h"

namespace mote::lights {

/// An eye ray's segment in one medium.
struct EyeLine {
    MediumLine line;             ///< the segment
    core::Rgb throughput{0.0f};  ///< of the eye path up to the line's origin
    core::MediumState state;     ///< media on the line
    std::int32_t max_depth = 0;  ///< of lights; deeper ones are left out
};

/// Light at the receiver's end of a segment [W/(m^2 sr)], and the segment.
struct LineConnection {
    core::Rgb value;      ///< without visibility and transmittance of the segment
    core::Vec3 from, to;  ///< ends of the segment: at the receiver, at the light
};

/// Generator and counters of connections.
struct LineContext {
    core::Rng& rng;                    ///< of transmittance estimates
    core::TrackingCounters& counters;  ///< of density lookups
};

/// An eye ray and a ray light; `u`: for the point on the light, and for the one on the eye ray. Nothing where
/// no light comes that way.
std::optional<LineConnection> connect(const EyeLine& eye, const RayLight& light, const core::Vec2& u,
                                      const LineContext& context);
/// A point, the lane of a tile, and a ray light. Of G* = C*(x)/w^2 counts min(G*, bound) [1/m^2].
std::optional<LineConnection> connect(const ReceiverLanes& receivers, int lane, const RayLight& light,
                                      float u, float bound, const LineContext& context);
/// An eye ray and a VPL on a surface.
std::optional<LineConnection> connect(const EyeLine& eye, const VplSet& vpls, const VirtualPointLight& vpl,
                                      float u, const LineContext& context);

}  // namespace mote::lights
