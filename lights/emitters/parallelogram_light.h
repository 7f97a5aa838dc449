// Lights that are a parallelogram of constant radiance, for methods that connect to many points at once.
#pragma once

#include <optional>

#include "core/geometry/triangle_mesh.h"

namespace mote::lights {

struct LitParallelogram {
    core::Parallelogram shape;
    core::Rgb radiance;  ///< from the side of the normal [W/(m^2 sr)]
};

/// A light that may be one. sample_direct() of such a light samples the point that Parallelogram states for
/// u.
class ParallelogramLight {
  public:
    virtual ~ParallelogramLight() = default;
    virtual std::optional<LitParallelogram> parallelogram() const = 0;
};

}  // namespace mote::lights
