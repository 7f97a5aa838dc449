// Where a point of a shape lies on the same shape at another time.
#pragma once

#include <optional>

#include "core/geometry/shape.h"

namespace mote::core {

/// `position` lies on the primitive of `now` [m]; the result on `then`, which is the same shape elsewhere,
/// turned, stretched or with its vertices moved: at the same barycentric coordinates, on the same place of a
/// sphere, in the same place of an instance. Curves are taken to be moved as a whole. Exactly `position`
/// where nothing was changed. Nothing where `then` is of another kind or made of other triangles.
std::optional<Vec3> moved_point(const Shape& now, std::uint32_t primitive, const Vec3d& position,
                                const Shape& then);

}  // namespace mote::core
