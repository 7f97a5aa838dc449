// Queries of algorithms that need the lights besides rays: a light to connect to, a light to
// start a particle from.
#pragma once

#include "core/scene/emitter.h"
#include "core/scene/ray_queries.h"

namespace mote::core {

/// A light sampled from the scene.
struct LightChoice {
    const Emitter* emitter;  ///< null: none
    float probability;       ///< of this choice
};

/// RayQueries with lights.
class LitScene : public RayQueries {
  public:
    /// All lights.
    virtual std::span<const std::shared_ptr<Emitter>> emitters() const = 0;
    /// The light at infinity with a picture, or null.
    virtual const Emitter* environment() const = 0;

    /// Light for a receiver. A null emitter: there is none to choose.
    virtual LightChoice choose_light(const LightReceiver& receiver, float u) const = 0;
    /// Probability that choose_light() returns this light; over all lights they add up to 1.
    virtual float light_probability(const LightReceiver& receiver, const Emitter* emitter) const = 0;
    /// Light for a particle. `remapped` is u, ready to be used again.
    virtual LightChoice choose_emitter_by_power(float u, float* remapped = nullptr) const = 0;
    /// With which probability choose_emitter_by_power() chooses it.
    virtual float probability_by_power(const Emitter* emitter) const = 0;

    /// Where a light without extent (point, spot) stands; nothing for all others.
    static std::optional<Vec3> light_position(const Emitter& emitter);
    /// The media at the origin of a light particle or at a light's position.
    virtual MediumState emitter_medium_state(const Emitter& emitter, const EmissionSample& sample) const = 0;
};

}  // namespace mote::core
