#include "lights/shadow_maps/light_shadow_maps.h"

#include "lights/emitters/light_cone.h"

namespace mote::lights {

using namespace core;

namespace {
/// Cones wider than this [radians] are mapped in all directions: on a plane their rim would take it all.
constexpr double widest_plane = 1.2;
}  // namespace

std::optional<ShadowMapView> shadow_map_view_of(const LitScene& scene, const Emitter& emitter, int size) {
    if (is_black(emitter.power())) return std::nullopt;
    if (emitter.traits().delta_direction) {
        const Bounds3 bounds = scene.bounds();
        const auto light = emitter.sample_direct(bounds.center(), Vec2(0.5f));
        if (!light) return std::nullopt;
        return ShadowMapView::of_parallel(-light->wi, bounds.center(), 1.001f * bounds.radius(), size);
    }
    const auto position = LitScene::light_position(emitter);
    if (!position) return std::nullopt;
    if (const auto* spot = dynamic_cast<const ConeLight*>(&emitter))
        if (const LightCone cone = spot->cone(); cone.angle < widest_plane)
            return ShadowMapView::of_spot(cone.apex, cone.axis, float(cone.angle), size);
    return ShadowMapView::of_point(*position, size);
}

LightShadowMaps::LightShadowMaps(const LitScene& scene, int size, const ShadowMapSettings& settings,
                                 const MemoryBudget& memory) {
    std::map<const Emitter*, ShadowMapView> views;
    for (const auto& emitter : scene.emitters())
        if (const auto view = shadow_map_view_of(scene, *emitter, size)) views.emplace(emitter.get(), *view);
    require_shadow_maps(memory, settings, views.size(), size, needs_chromatic_maps(scene));
    for (const auto& [emitter, view] : views)
        maps_[emitter].build(scene, view, scene.emitter_medium_state(*emitter, {}), settings);
}

std::size_t LightShadowMaps::memory_bytes() const {
    std::size_t sum = 0;
    for (const auto& [emitter, map] : maps_) sum += map.memory_bytes();
    return sum;
}

RayCounters LightShadowMaps::rays() const {
    RayCounters sum;
    for (const auto& [emitter, map] : maps_) sum.add(map.rays());
    return sum;
}

}  // namespace mote::lights
