// Shared parts of sphere, disk and cylinder.
#include "core/geometry/quadric.h"

#include "core/objects/error.h"

namespace mote::core {

std::optional<double> similarity_scale(const Transform& to_world) {
    const glm::dmat3 m(to_world.matrix);
    const double x = glm::length(m[0]), y = glm::length(m[1]), z = glm::length(m[2]);
    const double scale = std::cbrt(x * y * z);
    // Matrices in scene files often have six digits.
    const double tolerance = 1e-4 * scale;
    const bool uniform = std::fabs(x - scale) <= tolerance && std::fabs(y - scale) <= tolerance &&
                         std::fabs(z - scale) <= tolerance;
    const double shear =
        std::fmax(std::fabs(glm::dot(m[0], m[1])),
                  std::fmax(std::fabs(glm::dot(m[0], m[2])), std::fabs(glm::dot(m[1], m[2]))));
    if (!uniform || !(shear <= tolerance * scale)) return std::nullopt;
    return scale;
}

void fill_quadric_hit(const Vec3d& position, const Vec3d& normal, const Derivatives& derivatives,
                      const Vec2& uv, const Shape& shape, SurfaceHit& hit) {
    hit.position = Vec3(position);
    hit.geometric_normal = Vec3(normal);
    hit.error = quantization_error(hit.position, hit.geometric_normal);
    if (shape.tangent_matters) {
        hit.dp_du = Vec3(derivatives.dp_du), hit.dp_dv = Vec3(derivatives.dp_dv);
        hit.shading = Frame(hit.geometric_normal, hit.dp_du);
    } else {
        hit.shading = Frame(hit.geometric_normal);
    }
    hit.uv = uv;
    hit.shape = &shape;
    hit.primitive = 0;
}

ShapeSample quadric_sample(const Vec3d& position, const Vec3d& normal, const Vec2& uv, double pdf_area) {
    const Vec3 p(position), n(normal);
    return {p, n, uv, float(pdf_area), quantization_error(p, n)};
}

Bounds3 outward_bounds(const Vec3d& center, const Vec3d& half) {
    Bounds3 box;
    for (int axis = 0; axis < 3; ++axis) {
        const double slack = 0x1p-22 * (std::fabs(center[axis]) + half[axis]);
        box.lower[axis] = std::nextafter(float(center[axis] - half[axis] - slack), -infinity);
        box.upper[axis] = std::nextafter(float(center[axis] + half[axis] + slack), infinity);
    }
    return box;
}

}  // namespace mote::core
