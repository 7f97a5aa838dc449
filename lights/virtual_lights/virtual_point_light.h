// Virtual point lights: the vertices of light paths, kept as light sources (Keller 1997; Engelhardt 2013,
// Sec. 10.1).
//
// A VPL at y lights a receiver at x by  f*(x) G*(x,y) V*(x,y) I_j,  where I_j = f*(x<-y<-y') alpha / paths
// holds all that does not depend on x (Engelhardt 2013, Eqs. 10.3 to 10.5). On a diffuse surface and in an
// isotropic medium I_j is one colour. Everything else keeps the vertex it stands on, to evaluate f* per
// receiver: a VplDetail, stored apart, so that a plain VPL stays within one cache line.
#pragma once

#include <vector>

#include "core/scene/scattering_vertex.h"

namespace mote::lights {

/// One light of 64 bytes.
struct VirtualPointLight {
    static constexpr std::uint32_t no_detail =
        0xffffffffu;  ///< of a light that is the same in all directions

    core::Vec3 position;  ///< moved off the surface to its lit side, ready to be the end of a shadow ray
    std::uint32_t detail = no_detail;    ///< index into VplSet::details
    core::Vec3 normal{0, 0, 0};          ///< geometric, on the lit side; zero in a medium
    std::uint32_t depth = 1;             ///< vertices on the light path after the light: 1 for the first hit
    core::Vec3 shading_normal{0, 0, 0};  ///< on the lit side; zero in a medium
    std::uint32_t path = 0;              ///< index of the light path
    core::Rgb intensity{
        0.0f};  ///< I_j without detail [W/(sr m^2) on a surface's area measure]; with one: alpha / paths
    std::uint32_t reserved = 0;  ///< to fill the line

    /// Or in a medium.
    bool on_surface() const { return normal.x != 0.0f || normal.y != 0.0f || normal.z != 0.0f; }
};
static_assert(sizeof(VirtualPointLight) <= 64, "a diffuse or isotropic VPL fits one cache line");

/// Data of a directional VPL: its vertex, whose `wo` points back to where the light came from.
struct VplDetail {
    core::ScatteringVertex vertex;  ///< its own

    /// f*(x <- y <- y') with the adjoint correction of a shading normal; `to_receiver` is unit length.
    /// `peak_limit`: BsdfPoint::peak_limit.
    core::Rgb eval(const core::Vec3& to_receiver, float peak_limit = core::infinity) const;
    /// The correction in eval(), the light's end of it: |wi.ns| / |wi.ng|. The other end, |wo.ng|, is the
    /// cosine in G*.
    float incoming_correction() const;
};

/// Where a light path began. For lights at infinity any origin on the path's ray will do.
struct LightStart {
    const core::Emitter* emitter = nullptr;                           ///< null: there is no path
    core::Vec3 origin{0, 0, 0}, normal{0, 0, 0}, direction{0, 0, 1};  ///< of its EmissionSample
};

/// The VPLs of one set of light paths, in path order.
struct VplSet {
    std::vector<VirtualPointLight> lights;  ///< in the order of their paths
    std::vector<VplDetail> details;         ///< of those that look different from different sides
    /// Media at every light, on the side that its light came from; none where the scene has no media.
    std::vector<core::MediumState> states;
    /// By path: where it began. Only where LightPathSettings::keep_starts is set.
    std::vector<LightStart> starts;
    /// Known directions at both ends of a connection, for roughness clamping
    /// (compensation/roughness_clamping.h); without, nothing is clamped.
    std::vector<float> peak_density;  ///< by light: lights per area around it, over m' [1/m^2]
    float peak_directions = 0.0f;     ///< of the receivers' other directions, over m' [1/sr]; 0: none
    std::uint32_t paths = 0;          ///< light paths traced, whether or not they left a VPL
    core::RayCounters rays;           ///< that the paths took
    core::TrackingCounters tracking;  ///< that the paths took in media

    /// Bytes of all lists.
    std::size_t memory_bytes() const {
        return lights.size() * sizeof(VirtualPointLight) + details.size() * sizeof(VplDetail) +
               states.size() * sizeof(core::MediumState) + starts.size() * sizeof(LightStart) +
               peak_density.size() * sizeof(float);
    }
    /// Media on the side of a light that `direction` leaves to.
    core::MediumState state_towards(std::size_t light, const core::Vec3& direction) const;
};

/// The VPL for a vertex that light of weight alpha / paths arrived at, or nothing when it reflects no light
/// that could be connected. `vertex.wo` points back along the light path.
void append_vpl(VplSet& set, const core::ScatteringVertex& vertex, const core::Rgb& alpha,
                std::uint32_t depth, std::uint32_t path);

}  // namespace mote::lights
