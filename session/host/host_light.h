// Indirect light at places of another renderer's scene, by the many-light methods: one set of light paths,
// any number of receivers.
#pragma once

#include <memory>

#include "session/host/host_scene.h"

namespace mote::session {

/// Representation of the light that light paths leave behind.
enum class HostMethod : std::uint8_t {
    virtual_point_lights,
    ray_lights,  ///< segments in fog, and VPLs on surfaces
    photon_map
};
/// The method of a name: "vpl", "ray_lights", "photon_map". Throws InputError with the nearest name.
HostMethod host_method(const std::string& name);

struct HostLightSettings {
    HostMethod method = HostMethod::virtual_point_lights;
    std::uint32_t paths = 1024;     ///< light paths
    std::string selection = "all";  ///< of VPLs: a type of lights/selection
    float bound = core::infinity;   ///< of the geometry term of VPLs and of VPLs beside ray lights [1/m^2]
    int compensation_steps = 0;     ///< of the light that the bound takes from VPLs; -1: exact
    std::uint32_t neighbours = 50;  ///< photons of an estimate
    std::uint64_t seed = 1;         ///< of light paths and choices
};

/// Light of one set of light paths.
class HostLight {
  public:
    /// Traces the paths, in parallel. Keeps a reference to the scene. Throws InputError for settings that
    /// cannot be or do not go together.
    HostLight(const HostScene& scene, const HostLightSettings& settings);
    ~HostLight();

    /// VPLs, ray lights with VPLs, or photons on surfaces.
    std::size_t size() const;
    /// Radiance that each receiver reflects along its normal [W/(m^2 sr)], without what reaches it straight
    /// from lamps. In the caller's thread; safe from many. Receivers that follow each other should be near
    /// each other: they are gathered for sixteen at a time. The light paths are a random sample, so is the
    /// radiance.
    std::vector<core::Rgb> reflected(std::span<const HostReceiver> receivers) const;

    /// The part that one method fills in.
    class Method;

  private:
    std::unique_ptr<const Method> method_;
};

}  // namespace mote::session
