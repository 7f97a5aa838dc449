// What all lights ask of their parameters: brightness that is finite and not negative, directions that exist,
// transforms that keep angles.
#pragma once

#include <memory>
#include <string>

#include "core/math/transform.h"
#include "core/objects/properties.h"

namespace mote::core {
class Emitter;
class Medium;
}  // namespace mote::core

namespace mote::lights {

/// Above this, products of brightness, area and solid angle may leave the range of float.
inline constexpr float brightest = 1e30f;

/// The value itself, or InputError when a channel is negative, not finite or above `brightest`.
core::Rgb checked_brightness(const core::Rgb& value, const std::string& name,
                             const core::SourceLocation& where = {});
/// The parameter `name` as brightness; warns where it is black, for such a light emits nothing.
core::Rgb read_brightness(const core::Properties& properties, const std::string& name);

/// Unit vector, or InputError when it has no direction.
core::Vec3 checked_direction(const core::Vec3d& direction, const core::SourceLocation& where = {});

/// The linear part of a transform without its even scale: rows and columns of unit length. InputError when it
/// stretches or shears, for then solid angles would not be kept.
glm::mat3 checked_rotation(const core::Transform& to_world, const core::SourceLocation& where = {});

/// The medium that the scene file puts around a light with a position, or null.
std::shared_ptr<core::Medium> read_medium(const core::Properties& properties);

}  // namespace mote::lights
