// The affine map of texture coordinates that a scene file calls to_uv: the part of a transform that acts on u
// and v.
#pragma once

#include "core/math/transform.h"

namespace mote::core {

class UvTransform {
  public:
    UvTransform() = default;
    explicit UvTransform(const Transform& t)
        : linear_(t.matrix[0][0], t.matrix[0][1], t.matrix[1][0], t.matrix[1][1]),
          offset_(t.matrix[3][0], t.matrix[3][1]) {}

    /// Double precision, so that many repetitions keep their texels.
    glm::dvec2 operator()(const Vec2& uv) const { return linear_ * glm::dvec2(uv) + offset_; }
    /// Derivatives by u and v, from those by the transformed coordinates.
    glm::dvec2 gradient(const glm::dvec2& transformed) const { return glm::transpose(linear_) * transformed; }

  private:
    glm::dmat2 linear_{1.0};
    glm::dvec2 offset_{0.0};
};

}  // namespace mote::core
