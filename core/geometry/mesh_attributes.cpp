// Values that a mesh carries for its vertices and faces: looked up by name, interpolated, summed up.
#include <algorithm>

#include "core/geometry/triangle_mesh.h"

namespace mote::core {

const MeshAttribute* TriangleMesh::find_attribute(std::string_view name) const {
    for (const MeshAttribute& attribute : built_->data.attributes)
        if (attribute.name == name) return &attribute;
    return nullptr;
}

Rgb TriangleMesh::attribute_at(const MeshAttribute& attribute, std::uint32_t primitive, const Vec2& b) const {
    if (attribute.of_faces) return attribute.values[primitive];
    const auto& corner = built_->data.triangles[primitive];
    return (1.0f - b.x - b.y) * attribute.values[corner[0]] + b.x * attribute.values[corner[1]] +
           b.y * attribute.values[corner[2]];
}

Rgb TriangleMesh::attribute(std::string_view name, std::uint32_t primitive, const Vec2& barycentric) const {
    const MeshAttribute* found = find_attribute(name);
    return found ? attribute_at(*found, primitive, barycentric) : Rgb(0.0f);
}

Rgb TriangleMesh::attribute_mean(std::string_view name) const {
    const MeshAttribute* found = find_attribute(name);
    if (!found) return Rgb(0.0f);
    // Linear over a triangle: the value at its centre is its mean.
    Vec3d sum(0.0);
    const Distribution1D& shares = areas();
    for (std::uint32_t i = 0; i < built_->data.triangles.size(); ++i)
        sum += double(shares.probability(i)) * Vec3d(attribute_at(*found, i, Vec2(1.0f / 3.0f)));
    return Rgb(sum);
}

Vec2 TriangleMesh::attribute_range(std::string_view name) const {
    const MeshAttribute* found = find_attribute(name);
    if (!found) return Vec2(0.0f);
    Vec2 range(infinity, -infinity);
    for (const Rgb& value : found->values) {
        if (!is_finite(value)) return {std::nanf(""), std::nanf("")};
        range = {std::min(range.x, min_component(value)), std::max(range.y, max_component(value))};
    }
    return range;
}

}  // namespace mote::core
