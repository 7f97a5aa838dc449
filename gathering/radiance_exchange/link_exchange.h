// The exchange of radiance along the links of one bundle (Hermes 2010, Sec. 4.2 and 5).
//
// A ray represents the area s^2 perpendicular to its direction, s being the grid's spacing. Over the random
// offset of the grid the rays that meet a texel of area A are s^2-dense in its projection, so for a fixed
// direction w
//   E[ s^2 / A sum_rays L(w) ] = mean over the texel of L(w) cos,
// and with w or -w of density 1 / (2 pi) above the texel
//   2 pi s^2 / A sum_rays L(w)                                                                          (1)
// is an unbiased estimate of the texel's irradiance: Hermes 2010, Eq. 3, whose cosine is here in how many
// rays there are. What is summed here is L alone. A link adds the radiance of either end to the other, so the
// power that is sent, 2 pi s^2 L a link, is what is received.
#pragma once

#include <tbb/cache_aligned_allocator.h>

#include "gathering/atlas/surface_atlas.h"
#include "gathering/ray_bundles/ray_bundle.h"

namespace mote::gathering {

/// Three channels and something else, in one register.
struct alignas(16) Rgb4 {
    float r = 0.0f, g = 0.0f, b = 0.0f, more = 0.0f;
    void add(const Rgb4& o) { r += o.r, g += o.g, b += o.b; }
    core::Rgb rgb() const { return {r, g, b}; }
};
inline Rgb4 rgb4(const core::Rgb& c, float more = 0.0f) { return {c.x, c.y, c.z, more}; }
using Rgb4Vector = std::vector<Rgb4, tbb::cache_aligned_allocator<Rgb4>>;

/// Radiance that texels send along one direction and against it [W/(m^2 sr)].
struct SentRadiance {
    /// Radiance of Lambertian texels. `more` of a texel: 0, or 1 + its index in `glossy`, whose radiance
    /// holds instead.
    const Rgb4* reflected;
    const Rgb4* glossy;
    /// Emitted light, or null where it is not for bundles; `more` is 1 where there is any.
    const Rgb4* emitted;
    core::Rgb from_ahead{0.0f};   ///< of the environment in the bundle's direction; black if not for bundles
    core::Rgb from_behind{0.0f};  ///< against it
};

/// Sums of radiance over the rays that met a texel; zero before.
struct ReceivedRadiance {
    Rgb4* reflected;  ///< that had been reflected before
    Rgb4* emitted;    ///< that had not; may be null where nothing is emitted
};

/// Adds the radiance of every link, in the order of the rays. Returns how often rays met a texel.
std::uint64_t exchange_radiance(const SurfaceAtlas& atlas, const RayBundle& bundle, const SentRadiance& sent,
                                const ReceivedRadiance& received);

}  // namespace mote::gathering
