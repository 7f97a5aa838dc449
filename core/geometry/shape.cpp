// Shared by all shapes: light sampling by area, and leaving a surface without meeting it again.
#include "core/geometry/shape.h"

#include "core/geometry/rounding.h"
#include "core/math/pdf_conversion.h"

namespace mote::core {

std::optional<ShapeSample> Shape::sample_visible(const Vec3& p, const Vec2& u, float& pdf_solid_angle) const {
    ShapeSample sample = sample_area(u);
    const Vec3 to_light = sample.position - p;
    const float distance_squared = glm::dot(to_light, to_light);
    if (!(distance_squared > 0.0f)) return std::nullopt;
    const float cosine = glm::dot(sample.normal, to_light) / std::sqrt(distance_squared);
    pdf_solid_angle = area_to_solid_angle(sample.pdf_area, distance_squared, cosine);
    if (!(pdf_solid_angle > 0.0f) || !std::isfinite(pdf_solid_angle)) return std::nullopt;
    return sample;
}

float Shape::pdf_visible(const Vec3& p, const Vec3& wi, const SurfaceHit& hit) const {
    const Vec3 to_light = hit.position - p;
    return area_to_solid_angle(1.0f / area(), glm::dot(to_light, to_light),
                               glm::dot(hit.geometric_normal, wi));
}

}  // namespace mote::core
