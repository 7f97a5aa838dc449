#include "gathering/radiance_exchange/link_exchange.h"

namespace mote::gathering {

using namespace core;

namespace {

/// The texels on the sides of a hit that the ray comes to and leaves from.
struct HitTexels {
    std::uint32_t near, far;
};
HitTexels texels_of(const SurfaceAtlas& atlas, const BundleHit& hit) {
    const std::uint32_t triangle = hit.index();
    const float u = hit.u(), v = hit.v();
    const SurfaceSide near = hit.from_behind() ? SurfaceSide::back : SurfaceSide::front;
    const SurfaceSide far = hit.from_behind() ? SurfaceSide::front : SurfaceSide::back;
    return {atlas.texel(triangle, u, v, near), atlas.texel(triangle, u, v, far)};
}

const Rgb4& reflected_by(const SentRadiance& sent, std::uint32_t texel) {
    const Rgb4& plain = sent.reflected[texel];
    return plain.more == 0.0f ? plain : sent.glossy[std::size_t(plain.more) - 1];
}

template <bool Emission>
void send(const SentRadiance& sent, const ReceivedRadiance& received, std::uint32_t from, std::uint32_t to) {
    received.reflected[to].add(reflected_by(sent, from));
    if constexpr (Emission)
        if (sent.emitted[from].more != 0.0f) received.emitted[to].add(sent.emitted[from]);
}

std::uint64_t sides(const HitTexels& hit) {
    return std::uint64_t(hit.near != SurfaceAtlas::none) + std::uint64_t(hit.far != SurfaceAtlas::none);
}

template <bool Emission>
std::uint64_t exchange(const SurfaceAtlas& atlas, const RayBundle& bundle, const SentRadiance& sent,
                       const ReceivedRadiance& received) {
    constexpr std::uint32_t none = SurfaceAtlas::none;
    std::uint64_t met = 0;
    const Rgb4 ahead = rgb4(sent.from_ahead), behind = rgb4(sent.from_behind);
    for (std::size_t ray = 0; ray + 1 < bundle.first.size(); ++ray) {
        const auto hits = bundle.hits_of(ray);
        if (hits.empty()) continue;
        HitTexels last = texels_of(atlas, hits[0]);
        met += sides(last);
        if constexpr (Emission)
            if (last.near != none) received.emitted[last.near].add(behind);
        for (std::size_t i = 1; i < hits.size(); ++i) {
            const HitTexels here = texels_of(atlas, hits[i]);
            met += sides(here);
            if (last.far != none && here.near != none) {
                send<Emission>(sent, received, last.far, here.near);
                send<Emission>(sent, received, here.near, last.far);
            }
            last = here;
        }
        if constexpr (Emission)
            if (last.far != none) received.emitted[last.far].add(ahead);
    }
    return met;
}

}  // namespace

std::uint64_t exchange_radiance(const SurfaceAtlas& atlas, const RayBundle& bundle, const SentRadiance& sent,
                                const ReceivedRadiance& received) {
    return sent.emitted ? exchange<true>(atlas, bundle, sent, received)
                        : exchange<false>(atlas, bundle, sent, received);
}

}  // namespace mote::gathering
