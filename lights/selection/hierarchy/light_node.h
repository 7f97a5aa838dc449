// A node of a light tree: energy, positions and directions of a cluster of VPLs, for bounds and importances.
//
// A light j sends f*(x) w(G*(x,y_j)) I_j (Engelhardt 2013, Eqs. 10.4 and 10.5). Its energy E_j is I_j without
// what depends on direction: I_j itself where it is constant, alpha / 4 pi times a phase function's 1, alpha
// times albedo / pi for a glossy vertex. Its profile is I_j / E_j, and a node's profile is
// either that of Henyey-Greenstein's function about a cone of axes, or its peak.
//
// 64 bytes: a cache line.
#pragma once

#include <cstdint>

#include "core/math/bounds.h"
#include "core/math/direction_cone.h"
#include "core/math/octahedral.h"

namespace mote::lights {

/// Meaning of the cone of a node.
enum class LightKind : std::uint8_t {
    surface,  ///< normals: C* of the light's end is the cosine to one of them
    glossy,   ///< normals, where the profile times C* has a bound of its own, as a fraction of the peak
    volume,   ///< preferred directions of Henyey-Greenstein's function with |g| of [g_low, g_high]; C* is 1
    mixed     ///< none: C* is at most 1, the profile at most its peak
};

struct LightNode {
    core::Vec3 lower, upper;              ///< positions
    core::Rgb energy{0.0f};               ///< sum of E_j
    std::uint32_t axis_code = 0;          ///< of the cone (core/math/octahedral.h)
    float cos_angle = -1.0f;              ///< of the cone's half angle, which holds the error of the code
    float peak = 1.0f;                    ///< at least I_j / E_j of every light, direction and channel
    std::uint32_t left_count = 0;         ///< lights of the left child; the right one has the others
    std::uint32_t left_nodes = 0;         ///< nodes of the left child
    std::uint16_t g_low = 0, g_high = 0;  ///< in units of 1 / 65535, rounded outwards
    std::uint16_t min_depth = 0;          ///< at most VirtualPointLight::depth of every light
    /// Bound of profile times C* of a glossy node; stored over the peak, in units of 1 / 65535.
    void set_grazing(float bound) {
        const float ratio = peak > 0.0f && peak < core::infinity ? bound / peak : 1.0f;
        g_low = 0, g_high = std::uint16_t(std::min(std::ceil(ratio * 65535.0f * (1.0f + 1e-5f)), 65535.0f));
    }
    float peak_times_cosine() const {
        return kind == LightKind::glossy ? float(g_high) * (1.0f / 65535.0f) : 1.0f;
    }
    LightKind kind = LightKind::surface;
    std::uint8_t reserved = 0;

    float weight() const { return core::average(energy); }
    core::Vec3 axis() const { return core::decode_direction(axis_code); }
    void set_cone(const core::DirectionCone& cone) {
        axis_code = core::encode_direction(cone.axis);
        const float angle = cone.empty() ? core::pi : cone.angle + 2e-4f;
        cos_angle = angle < core::pi ? std::max(std::cos(angle) - 1e-7f, -1.0f) : -1.0f;
    }
    core::DirectionCone cone() const {
        return cos_angle > -1.0f ? core::DirectionCone{axis(), std::acos(std::min(cos_angle, 1.0f))}
                                 : core::DirectionCone::all();
    }
    float diagonal2() const { return glm::dot(upper - lower, upper - lower); }
};
static_assert(sizeof(LightNode) == 64);

/// Union of two nodes, without left_count and left_nodes.
LightNode united(const LightNode& a, const LightNode& b);

/// Leaves of a light tree. VPLs are one set (vertex_bounds.h); whatever has a position, an energy and a cone
/// can be another. All functions are safe from many threads.
class LightLeaves {
  public:
    virtual ~LightLeaves() = default;
    virtual std::size_t size() const = 0;
    /// Node of one light; its energy is finite, and 0 where it sends no light.
    virtual LightNode leaf(std::uint32_t light) const = 0;
};

}  // namespace mote::lights
