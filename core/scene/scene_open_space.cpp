// Boxes without boundaries: between points of the largest one that was found, which is the inside of a room
// of fog as a rule, rays do not look for boundaries at all.
#include <algorithm>

#include "core/geometry/triangle_mesh.h"
#include "core/scene/scene.h"

namespace mote::core {
namespace {

/// True if a boundary may pass through the box, so that its two ends lie in different media. Triangles are
/// compared by their bounds; of analytic shapes the bounds of the whole are all that is known.
bool may_cross(const Shape& boundary, const Bounds3& box) {
    const auto overlap = [&](const Bounds3& b) {
        return glm::all(glm::lessThanEqual(b.lower, box.upper)) &&
               glm::all(glm::greaterThanEqual(b.upper, box.lower));
    };
    if (!overlap(boundary.bounds())) return false;
    const auto* mesh = dynamic_cast<const TriangleMesh*>(&boundary);
    if (!mesh) return true;
    const MeshData& data = mesh->data();
    return std::any_of(data.triangles.begin(), data.triangles.end(), [&](const auto& triangle) {
        Bounds3 b;
        for (const std::uint32_t vertex : triangle) b.extend(data.positions[vertex]);
        return overlap(b);
    });
}

double volume(const Bounds3& box) {
    const Vec3d size(box.diagonal());
    return box.empty() ? 0.0 : size.x * size.y * size.z;
}

}  // namespace

bool Scene::any_boundary_in(const Bounds3& box, const Shape* except) const {
    return std::any_of(boundaries_.begin(), boundaries_.end(),
                       [&](const Boundary& b) { return b.shape != except && may_cross(*b.shape, box); });
}

/// The inside of each boundary that is a box along the axes, a little smaller, so that no point in it is
/// within rounding of the boundary.
void Scene::find_open_space() {
    std::vector<const Shape*> straight;
    for (const auto& shape : parts_.shapes)
        if (shape->bsdf->traits().passes_straight()) straight.push_back(shape.get());
    constexpr float margin = 1e-3f;
    for (const Shape* shape : straight) {
        Bounds3 box = shape->bounds();
        const Vec3 inwards = margin * box.diagonal();
        box.lower += inwards, box.upper -= inwards;
        if (!(volume(box) > volume(open_space_))) continue;
        if (std::none_of(straight.begin(), straight.end(),
                         [&](const Shape* s) { return may_cross(*s, box); }))
            open_space_ = box;
    }
}

}  // namespace mote::core
