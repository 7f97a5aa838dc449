// Points of a scene with the light that they reflect: what the receivers of a pass gather from.
#pragma once

#include <memory>
#include <optional>

#include "gathering/stored_light/arriving_light.h"
#include "gathering/stored_light/point_radiosity.h"
#include "lights/virtual_lights/light_path.h"

namespace mote::gathering {

/// Where the light of points comes from, beyond lights themselves.
enum class StoredLight : std::uint8_t {
    direct,     ///< nothing
    vpls,       ///< virtual point lights (Fig. 8.6)
    radiosity,  ///< other points (Fig. 8.7)
    photons     ///< the density of photons (Fig. 8.8)
};

struct LitPointSettings {
    std::uint32_t points = 65536;
    StoredLight light = StoredLight::direct;
    int bounces = 6;                  ///< reflections between points; the first has direct light
    lights::LightPathSettings paths;  ///< of virtual point lights, or of photons
    float bound = core::infinity;     ///< on G* between a virtual point light and a place [1/m^2]
    std::size_t memory_budget = std::size_t(1) << 30;  ///< of points and their hierarchy, each [B]
};

/// Cost of making the light of a pass.
struct LitPointCost {
    core::RayCounters rays;
    core::TrackingCounters tracking;
    std::size_t places = 0, light_points = 0, bytes = 0;  ///< `light_points`: virtual lights or photons
};

class LitPoints {
  public:
    /// Throws the InputError of points beyond the budget, before anything is made.
    static void check_memory(const LitPointSettings& settings);
    /// Points of (seed, pass) in a scene without media. Keeps references to `surfaces` and `shapes`, those of
    /// the scene. Throws core::Cancelled, and InputError where the points exceed the budget.
    LitPoints(const core::LitScene& scene, const SurfaceTriangles& surfaces, ShapeSpan shapes,
              const LitPointSettings& settings, const MicroBufferSettings& buffers, std::uint64_t seed,
              std::uint32_t pass, core::SamplerKind sampler, core::CancelToken cancelled);
    LitPoints(const LitPoints&) = delete;
    LitPoints& operator=(const LitPoints&) = delete;

    const MicroBuffers& buffers() const { return *buffers_; }
    /// Light that points reflect; emission is none of it.
    const NodeRadiance& radiance() const { return *radiance_; }
    const Surfels& surfels() const { return surfels_; }
    const LitPointCost& cost() const { return cost_; }

  private:
    std::vector<core::Rgb> arriving(const core::LitScene& scene, const SurfelSides& sides,
                                    const LitPointSettings& settings, std::uint64_t seed, std::uint32_t pass,
                                    core::SamplerKind sampler, core::CancelToken cancelled);

    Surfels surfels_;
    std::optional<PointHierarchy> hierarchy_;
    std::optional<MicroBuffers> buffers_;
    std::optional<NodeRadiance> radiance_;
    LitPointCost cost_;
};

}  // namespace mote::gathering
