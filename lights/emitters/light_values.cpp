#include "lights/emitters/light_values.h"

#include <fmt/format.h>

namespace mote::lights {

using namespace core;

Rgb checked_brightness(const Rgb& value, const std::string& name, const SourceLocation& where) {
    // NaN fails both comparisons.
    if (min_component(value) >= 0.0f && max_component(value) <= brightest && is_finite(value)) return value;
    throw InputError(
        fmt::format("'{}' of a light must be finite, not negative and at most {:g}: it is {} {} {}", name,
                    brightest, value.x, value.y, value.z),
        where);
}

Range brightness(std::string unit) { return between(0, double(brightest), std::move(unit)); }

void warn_of_black(const Properties& properties, const std::string& name, float largest) {
    if (!(largest > 0.0f)) properties.warn("'" + name + "' is zero: this light emits nothing");
}

Vec3 checked_direction(const Vec3d& direction, const SourceLocation& where) {
    const double length = glm::length(direction);
    if (!(length > 0.0) || !std::isfinite(length))
        throw InputError("the direction of a light has no length or is not finite", where);
    return Vec3(direction / length);
}

glm::mat3 checked_rotation(const Transform& to_world, const SourceLocation& where) {
    if (!to_world.valid()) throw InputError("the light's to_world is singular or not finite", where);
    const glm::dmat3 m(to_world.matrix);
    const double scale = std::cbrt(std::fabs(to_world.determinant()));
    const glm::dmat3 rotation = m * (1.0 / scale);
    const glm::dmat3 gram = glm::transpose(rotation) * rotation;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::fabs(gram[column][row] - (row == column ? 1.0 : 0.0)) < 1e-4))
                throw InputError(
                    "the light's to_world stretches or shears; it may only rotate, mirror, move and scale "
                    "evenly",
                    where);
    return glm::mat3(rotation);
}

}  // namespace mote::lights
