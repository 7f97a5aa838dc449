// What is known of a group of lights: enough to bound what it could send, and to estimate what it does.
//
// A light j sends f*(x) w(G*(x,y_j)) I_j (Engelhardt 2013, Eqs. 10.4 and 10.5). Its energy E_j is I_j without
// what depends on direction: I_j itself where it is constant, alpha / 4 pi times a phase function's 1, alpha
// times albedo / pi for a glossy vertex. Its profile is I_j / E_j, and what a node knows of the profile is
// either that of Henyey-Greenstein's function about a cone of axes, or its peak.
//
// 64 bytes: a cache line.
#pragma once

#include <cstdint>

#include "core/math/bounds.h"
#include "core/math/direction_cone.h"
#include "core/math/octahedral.h"

namespace mote::lights {

/// What the cone of a node is a cone of.
enum class LightKind : std::uint8_t {
    surface,  ///< normals: C* of the light's end is the cosine to one of them
    glossy,   ///< normals, where the profile times C* has a bound of its own, a share of the peak
    volume,   ///< preferred directions of Henyey-Greenstein's function with |g| of [g_low, g_high]; C* is 1
    mixed     ///< nothing: C* is at most 1, the profile at most its peak
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
    std::uint16_t least_depth = 0;        ///< at most VirtualPointLight::depth of every light
    /// Of a glossy node: profile times C* is at most so much of the peak, in units of 1 / 65535.
    void set_grazing(float most) {
        const float share = peak > 0.0f && peak < core::infinity ? most / peak : 1.0f;
        g_low = 0, g_high = std::uint16_t(std::min(std::ceil(share * 65535.0f * (1.0f + 1e-5f)), 65535.0f));
    }
    float most_times_cosine() const {
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

/// Both together. left_count and left_nodes are left for whoever makes the tree.
LightNode united(const LightNode& a, const LightNode& b);

/// The lights that a hierarchy is made of. Virtual point lights are one set (vpl_leaves.h); whatever has a
/// place, an energy and a cone can be another. All functions are safe from many threads.
class LightLeaves {
  public:
    virtual ~LightLeaves() = default;
    virtual std::size_t size() const = 0;
    /// A node of this light alone; its energy is finite, and 0 where it lights nothing.
    virtual LightNode leaf(std::uint32_t light) const = 0;
};

}  // namespace mote::lights
