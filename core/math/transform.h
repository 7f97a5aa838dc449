// Affine transforms, kept in double precision from the scene file to the vertices.
#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include "core/math/vec.h"

namespace mote::core {

struct Transform {
    glm::dmat4 matrix{1.0};  ///< column vectors: p' = matrix * p

    Transform() = default;
    /// Transform by a matrix for column vectors.
    explicit Transform(const glm::dmat4& m) : matrix(m) {}

    /// Moved, turned and scaled.
    Vec3d point(const Vec3d& p) const { return Vec3d(matrix * glm::dvec4(p, 1.0)); }
    Vec3d vector(const Vec3d& v) const { return Vec3d(matrix * glm::dvec4(v, 0.0)); }  ///< turned and scaled
    /// Normals transform by the inverse transpose; the result has unit length.
    Vec3d normal(const Vec3d& n) const {
        return glm::normalize(glm::transpose(glm::inverse(glm::dmat3(matrix))) * n);
    }
    /// Undefined where the determinant is 0.
    Transform inverse() const { return Transform(glm::inverse(matrix)); }
    /// Determinant of the linear part: factor on volumes, negative where it mirrors.
    double determinant() const { return glm::determinant(glm::dmat3(matrix)); }
    /// True when every entry is finite and the linear part can be inverted.
    bool valid() const {
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                if (!std::isfinite(matrix[c][r])) return false;
        const glm::dmat3 m(matrix);
        const double scale = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
        return scale > 0.0 && std::fabs(glm::determinant(m)) > 1e-12 * scale;
    }
    /// b first, then a.
    friend Transform operator*(const Transform& a, const Transform& b) {
        return Transform(a.matrix * b.matrix);
    }
};

}  // namespace mote::core
