// The light that arrives at every texel of an atlas, by global ray-bundles (Hermes 2010; Sbert 1996).
//
// With T_b the transport of a batch of directions, an unbiased estimate of the light transport operator T,
// E the emitted light and P its direct part:
//
// One bounce at a time: light of bounce k is the mean of T_b over directions of its own, applied to what
// bounce k - 1 left. After n bounces all light is there that was reflected n times or less.
//
// Interleaved (Hermes 2010, Sec. 5.5): what a batch received is sent by the next one,
//   L_b = P + T_b L_{b-1},                                                                               (2)
// and the result is the mean of T_b L_{b-1} over batches. Batches are independent, so the mean of L_b is
// sum_{k <= b} T^k P: each path length once, those above b missing, which falls with the power of the
// albedo. (Stochastic iteration, Szirmay-Kalos 1999.) The text of Hermes adds 2 pi / N of every direction to
// one sum that is sent as it is: that sum holds i / N of the light after i directions, and in a closed
// furnace ends at E (e^rho - 1) / rho instead of E / (1 - rho); a running mean ends right, but is off by
// N^(rho - 1). See docs/errata.md.
// A batch of one direction is Hermes's exchange after every direction; its variance is finite for albedos
// below sqrt(3)/2 alone, since E[(2 rho cos)^2] = 4/3 rho^2.
//
// Glossy texels send towards each of the next directions what they received from each of the last: with the
// next direction known (Hermes 2010, Eq. 4), f(w, w') L cos, the mean over the last batch.
#pragma once

#include "gathering/radiance_exchange/exchange_batch.h"
#include "gathering/radiance_exchange/texel_direct_light.h"

namespace mote::gathering {

/// Batch by batch, or one bounce after the other.
enum class LightTransfer : std::uint8_t { interleaved, one_bounce };

struct ExchangeSettings {
    LightTransfer transfer = LightTransfer::interleaved;  ///< what is sent on, and when
    std::uint32_t directions = 512;                       ///< in all
    std::uint32_t batch = 16;  ///< directions after which sender and receiver are exchanged
    /// Interleaved: batches whose indirect light is sent on, but not counted. After each of them indirect
    /// light is scaled so that its power balances, which is where the slowest part would converge to.
    std::uint32_t warm_up = 8;
    std::uint32_t bounces = 8;    ///< one bounce at a time: reflections followed, the last towards the eye
    float rays_per_texel = 1.0f;  ///< of a texel seen at right angles
    bool lights = true;           ///< bundles carry the light of area lights and of the environment
    bool glossy = true;           ///< glossy texels reflect (interleaved alone)
};

/// Irradiance at every texel [W/m^2].
struct ArrivingLight {
    std::vector<core::Rgb> direct;    ///< of lights, where bundles carry it, without that of TexelDirectLight
    std::vector<core::Rgb> indirect;  ///< that was reflected before
};

/// Counters that every exchange adds to.
struct ExchangeStatistics {
    std::uint64_t directions = 0;  ///< that carried light
    std::uint64_t hits = 0;        ///< of their rays with surfaces
    std::size_t bytes = 0;         ///< of the sums
};

/// One independent estimate for each key. `direct` is what arrives besides, irradiance empty where nothing
/// does. Throws Cancelled.
ArrivingLight exchange_light(const ExchangeScene& scene, const ExchangeSettings& settings,
                             const TexelDirectLight& direct, std::uint64_t key, core::CancelToken cancelled,
                             ExchangeStatistics& statistics);

/// Memory for the sums of a batch [B].
std::size_t exchange_bytes(std::size_t texels, const ExchangeSettings& settings);

}  // namespace mote::gathering
