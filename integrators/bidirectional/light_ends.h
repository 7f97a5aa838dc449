// Lights as the end of a path: which one a light path starts from, and with which densities any technique
// finds a point on a light.
#pragma once

#include <unordered_map>

#include "core/math/distribution.h"
#include "core/scene/lit_scene.h"

namespace mote::integrators {

/// A point on a light, or a direction to one at infinity.
struct LightPoint {
    const core::Emitter* emitter = nullptr;
    core::Vec3 position{0.0f};  ///< of a light at infinity any on the ray to it, such as the receiver's
    core::Vec3 normal{0.0f};    ///< zero where the light has no surface
    core::Vec3 wi{0.0f};        ///< unit, from the receiver to the light

    bool infinite() const { return emitter->traits().infinite; }
    /// From solid angle at a receiver to area on the light; 1 where the light's measure is the solid angle,
    /// or a delta.
    double area_measure(double distance_squared) const {
        if (infinite()) return 1.0;
        const double cosine = normal == core::Vec3(0.0f) ? 1.0 : std::fabs(double(glm::dot(normal, wi)));
        return cosine / distance_squared;
    }
};

/// Lights sampled by power for light paths. The emission of media is no end here: an eye path adds what it
/// meets of it, which no other technique looks for.
class LightEnds {
  public:
    explicit LightEnds(const core::LitScene& scene);

    core::LightChoice choose(float u, float* remapped) const;
    float probability(const core::Emitter* emitter) const;

    /// Densities with which a light path starts at the point, and with which it then samples a receiver in
    /// the direction -wi.
    struct Start {
        double light = 0.0;     ///< per area; of lights at infinity per solid angle
        double receiver = 0.0;  ///< per solid angle; of lights at infinity per area across the direction
        /// Density of a receiver `distance_squared` away, per area.
        double of(double cosine, double distance_squared, bool infinite) const {
            return receiver * cosine / (infinite ? 1.0 : distance_squared);
        }
    };
    Start start(const LightPoint& point) const;

    /// Density with which a receiver samples the point (LitScene::choose_light and Emitter::sample_direct),
    /// in the measure of Start::light; 0 where it never does.
    double sampled(const core::LightReceiver& receiver, const LightPoint& point,
                   double distance_squared) const;

  private:
    const core::LitScene& scene_;
    core::Distribution1D by_power_;
    std::unordered_map<const core::Emitter*, std::size_t> index_;
};

}  // namespace mote::integrators
