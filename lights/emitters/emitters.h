// The primary lights of a scene, for callers that build scenes in code; scene files reach them through the
// registry. Angles are in radians, directions need not have unit length, colours are linear RGB.
//
// Every maker throws core::InputError for values that are negative, not finite or out of range.
#pragma once

#include <memory>

#include "core/formats/pictures/image_file.h"
#include "core/materials/texture_rows.h"
#include "core/math/transform.h"
#include "core/scene/emitter.h"

namespace mote::core {
class Registry;
}

namespace mote::lights {

/// Equal intensity [W/sr] in all directions.
std::shared_ptr<core::Emitter> make_point_light(const core::Vec3d& position, const core::Rgb& intensity);

/// A cone around +z of to_world: full intensity [W/sr] inside `beam_width`, falling linearly in the angle to
/// zero at `cutoff_angle`. The texture, where there is one, is projected through the cone and multiplies.
struct SpotSettings {
    core::Transform to_world{};                                   ///< of the cone
    core::Rgb intensity{1.0f};                                    ///< [W/sr]
    double cutoff_angle = 20.0 * 3.14159265358979323846 / 180.0;  ///< [radians]
    double beam_width = 15.0 * 3.14159265358979323846 / 180.0;    ///< [radians]
    core::TexturePtr texture{};                                   ///< may be null
};
/// A cone of light.
std::shared_ptr<core::Emitter> make_spot_light(const SpotSettings& settings);

/// A picture projected along +z of to_world (which must not scale): on a surface that faces the projector at
/// distance 1 it gives the irradiance pi times `scale` times `irradiance` [W/m^2]. Null: white.
struct ProjectorSettings {
    core::Transform to_world{};     ///< of the projector
    core::TexturePtr irradiance{};  ///< the picture
    float scale = 1.0f;             ///< of the picture
    double tan_half_fov_x =
        0.5;  ///< half the picture's width at distance 1; the height follows from its aspect
};
/// A projector.
std::shared_ptr<core::Emitter> make_projector_light(const ProjectorSettings& settings);

/// Parallel light; `irradiance` [W/m^2] is what a surface facing the light receives.
std::shared_ptr<core::Emitter> make_directional_light(const core::Vec3d& direction,
                                                      const core::Rgb& irradiance);

/// The front side of a shape (where its geometric normal points to) emits `radiance` [W/(m^2 sr)] in all
/// directions. One light belongs to one shape: call set_shape() before use.
std::shared_ptr<core::Emitter> make_area_light(const core::Rgb& radiance);
/// An area light with radiance by the shape's texture coordinates.
std::shared_ptr<core::Emitter> make_area_light(core::TexturePtr radiance);

/// Equal radiance [W/(m^2 sr)] from every direction.
std::shared_ptr<core::Emitter> make_constant_light(const core::Rgb& radiance);

/// Radiance from a latitude-longitude picture (see environment_picture.h); to_world may rotate and
/// mirror.
std::shared_ptr<core::Emitter> make_environment_map(core::Bitmap picture,
                                                    const core::Transform& to_world = {}, float scale = 1.0f);

// Called by register_lights(); each is defined beside its light.
void register_point(core::Registry& registry);
void register_spot(core::Registry& registry);
void register_projector(core::Registry& registry);
void register_directional(core::Registry& registry);
void register_area(core::Registry& registry);
void register_constant(core::Registry& registry);
void register_envmap(core::Registry& registry);

}  // namespace mote::lights
