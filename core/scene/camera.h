// The interface of sensors: from a point on the film to a ray.
//
// Film positions are in pixels: x to the right in [0, width), y down in [0, height).
#pragma once

#include <memory>
#include <optional>

#include "core/math/ray.h"
#include "core/math/transform.h"
#include "core/objects/error.h"
#include "core/objects/object.h"

namespace mote::core {

class Medium;
class Film;

class Camera : public Object {
  public:
    /// The ray through `film_position`; `u_lens` chooses the point on a lens. t_min and t_max hold the near
    /// and far clipping planes. The weight of every ray is 1.
    virtual Ray sample_ray(const Vec2& film_position, const Vec2& u_lens) const = 0;

    /// Where the camera stands: used to find the medium around it and for metadata.
    virtual Vec3 position() const = 0;
    virtual Transform to_world() const = 0;

    std::shared_ptr<Medium> medium;  ///< the medium around the camera where the scene file names one
    SourceLocation medium_where;     ///< of that name
};

}  // namespace mote::core
