// Checks of the parameters of lights: brightness that is finite and not negative, directions that exist,
// transforms that keep angles.
#pragma once

#include <memory>
#include <string>

#include "core/math/transform.h"
#include "core/parameters/add_type.h"
#include "core/scene/medium.h"

namespace mote::lights {

/// Above this, products of brightness, area and solid angle may leave the range of float.
inline constexpr float brightest = 1e30f;

/// The value itself, or InputError when a channel is negative, not finite or above `brightest`.
core::Rgb checked_brightness(const core::Rgb& value, const std::string& name,
                             const core::SourceLocation& where = {});
/// Values that the brightness of a light may have.
core::Range brightness(std::string unit = "");
/// Warns where the parameter `name` is black: such a light emits nothing.
void warn_of_black(const core::Properties& properties, const std::string& name, float largest);

/// Unit vector, or InputError when it has no direction.
core::Vec3 checked_direction(const core::Vec3d& direction, const core::SourceLocation& where = {});

/// The linear part of a transform without its even scale: rows and columns of unit length. InputError when it
/// stretches or shears, for then solid angles would not be kept.
glm::mat3 checked_rotation(const core::Transform& to_world, const core::SourceLocation& where = {});

/// The medium around a light with a position.
template <typename S>
core::Rows<S> medium_row() {
    return core::nested("medium", &S::medium, core::Category::medium, "automatic",
                        "The medium around the light; when absent, that of the shapes around it, or the "
                        "outermost one.");
}

}  // namespace mote::lights
