// A photon: the power that a light particle brought to a point (Jensen 2001, Ch. 5).
#pragma once

#include "core/math/octahedral.h"
#include "core/scene/scattering_vertex.h"

namespace mote::gathering {

/// Thirty-two bytes. `power` is that of the particle over the number of paths [W]; in a medium it holds the
/// albedo at the photon, so that a sum over photons is a sum over scattered light.
struct Photon {
    core::Vec3 position;             ///< [m]
    std::uint32_t towards_light;     ///< core::encode_direction: back along the path
    core::Rgb power;                 ///< [W]
    std::uint16_t normal_or_medium;  ///< surface: encoded geometric normal; medium: index into Scene::media()
    std::uint16_t depth;             ///< vertices of the light path up to here, 1 at the first; 65535 or more
};
static_assert(sizeof(Photon) == 32);

/// A surface normal in 16 bits (within about 0.02 rad): enough to distinguish one wall from the next.
inline std::uint16_t encode_normal(const core::Vec3& n) {
    const core::Vec2 p = core::octahedral_project(n);
    const auto quantize = [](float x) { return std::uint32_t(std::lround((x * 0.5f + 0.5f) * 255.0f)); };
    return std::uint16_t(quantize(p.x) | quantize(p.y) << 8);
}
/// The unit normal of such a code.
inline core::Vec3 decode_normal(std::uint16_t code) {
    const auto expand = [](std::uint32_t bits) { return float(bits) * (2.0f / 255.0f) - 1.0f; };
    return core::octahedral_unproject({expand(code & 0xffu), expand(std::uint32_t(code) >> 8)});
}

}  // namespace mote::gathering
