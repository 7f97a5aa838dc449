// Scenes for bundles from the eye: a room with a corner, and a spot that a light close to the wall makes.
#pragma once

#include <string>

#include "core/scene/scene.h"
#include "tests/support/render_statistics.h"

namespace mote::tests {

inline const std::string point_by_the_wall =
    R"(<emitter type="point"><point name="position" x="0.9" y="-0.2" z="0.1"/><rgb name="intensity" value="3, 2, 1"/></emitter>)";
inline const std::string lamp =
    R"(<shape type="rectangle"><transform name="to_world"><scale value="0.25"/><rotate x="1" angle="90"/>
        <translate y="0.6"/></transform><emitter type="area"><rgb name="radiance" value="10, 8, 6"/></emitter></shape>)";
inline const std::string ball_lamp =
    R"(<shape type="sphere"><float name="radius" value="0.15"/><point name="center" x="-0.5" y="-0.4" z="0.2"/>
        <emitter type="area"><rgb name="radiance" value="9, 7, 8"/></emitter></shape>)";
inline const std::string sky =
    R"(<emitter type="constant"><rgb name="radiance" value="1, 1.2, 1.5"/></emitter>)";
inline const std::string sun =
    R"(<emitter type="directional"><vector name="direction" x="0.4" y="-0.8" z="-0.3"/><rgb name="irradiance" value="3"/></emitter>)";

/// Floor, back and right wall of [-1, 1]^3, open else, of one BSDF.
inline std::string corner_room(const std::string& bsdf, const std::string& lights) {
    const auto wall = [&](const std::string& transform) {
        return R"(<shape type="rectangle"><transform name="to_world"><translate z="-1"/>)" + transform +
               "</transform>" + bsdf + "</shape>";
    };
    return R"(<scene version="3.0.0">)" + wall("") + wall(R"(<rotate x="1" angle="-90"/>)") +
           wall(R"(<rotate y="1" angle="-90"/>)") + lights +
           R"(<sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
        <lookat origin="-1.4, 1.2, 3" target="0.2, -0.5, 0" up="0, 1, 0"/></transform></sensor></scene>)";
}

inline const std::string matt =
    R"(<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></bsdf>)";
inline const std::string shiny =
    R"(<bsdf type="twosided"><bsdf type="roughplastic"><float name="alpha" value="0.3"/>
    <rgb name="diffuse_reflectance" value="0.5, 0.4, 0.3"/></bsdf></bsdf>)";

/// The first surface on a ray, which must be one with a smooth part.
inline core::ScatteringVertex vertex_on(const core::Scene& scene, const core::Vec3& origin,
                                        const core::Vec3& direction) {
    const core::Ray ray{origin, glm::normalize(direction)};
    const auto hit = scene.first_hit(ray);
    if (!hit) throw std::runtime_error("the ray meets nothing");
    core::WalkEvent event;
    event.kind = core::WalkEvent::Kind::surface, event.hit = *hit, event.distance = hit->t;
    return make_vertex(event, ray);
}

}  // namespace mote::tests
