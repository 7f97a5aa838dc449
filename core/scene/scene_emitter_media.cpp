// Media that surround the lights: found once for every light that does not reach through a boundary.
#include <algorithm>

#include "core/objects/error.h"
#include "core/scene/light_from_infinity.h"
#include "core/scene/scene.h"

namespace mote::core {

/// The state at a point of an area light, on the side that its normal points to.
MediumState Scene::area_light_state(const Emitter& emitter, const Shape& shape, const Vec3& p,
                                    const Vec3& normal) const {
    // Before a boundary that coincides with the light, as scene_boundaries.cpp has it.
    const float beyond_rounding = 1e-6f * max_component(glm::abs(p));
    const Vec3 start =
        offset_origin(p, normal, std::fmax(shape.sample_area({0.5f, 0.5f}).error, beyond_rounding), normal);
    const Medium* declared = emitter.medium ? emitter.medium : shape.exterior.get();
    return medium_state_near(start, declared, &shape);
}

/// Transmittance over an infinite distance is zero: paths from the eye would find nothing of a light at
/// infinity, and particles, which start at the scene's bounds, would find something. Open walls may have
/// something else behind them.
void Scene::check_light_from_infinity(const Emitter& emitter, const Medium* around) const {
    if (!emitter.traits().infinite || outside_is_parted_ || !around || !blocks_infinity(*around)) return;
    throw InputError(
        "no light from infinity comes through the medium around the scene, which has no end: make it the "
        "interior of a shape, or use lights inside the scene",
        outermost_where_);
}

void Scene::find_emitter_states() {
    for (const auto& shape : parts_.shapes) {
        if (!shape->emitter) continue;
        if (any_boundary_in(shape->bounds(), shape.get())) continue;  // found particle by particle
        const ShapeSample s = shape->sample_area({0.37f, 0.61f});
        emitter_states_[shape->emitter.get()] =
            area_light_state(*shape->emitter, *shape, s.position, s.normal);
    }
    for (const auto& emitter : parts_.emitters) {
        const EmitterTraits traits = emitter->traits();
        if (traits.kind == EmitterKind::area) continue;
        MediumState state;
        state.set_outside(outside_is_parted_ && emitter->medium ? emitter->medium : outermost_);
        check_light_from_infinity(*emitter, state.current());
        // Particles come from all directions, and open walls part what is there: found particle by particle.
        if (traits.infinite && outside_is_parted_ && !emitter->medium) continue;
        if (!traits.infinite) {
            const auto position = light_position(*emitter);
            if (!position) continue;
            state = medium_state_at(*position, emitter->medium);
        }
        emitter_states_[emitter.get()] = state;
    }
}

MediumState Scene::emitter_medium_state(const Emitter& emitter, const EmissionSample& sample) const {
    if (const auto it = emitter_states_.find(&emitter); it != emitter_states_.end()) return it->second;
    if (sample.shape) return area_light_state(emitter, *sample.shape, sample.origin, sample.normal);
    return medium_state_at(sample.origin, emitter.medium);
}

}  // namespace mote::core
