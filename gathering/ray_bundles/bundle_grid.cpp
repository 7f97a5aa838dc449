#include "gathering/ray_bundles/bundle_grid.h"

#include <fmt/format.h>

#include "core/math/frame.h"
#include "core/objects/error.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr double max_rays = 0x1p31;

struct Extent {
    double lower = infinity, upper = -infinity;
    double length() const { return upper - lower; }
};

/// Extent of the box along an axis [m].
Extent extent_along(const Bounds3& box, const Vec3& axis) {
    const Vec3d a(axis), center = 0.5 * Vec3d(box.lower) + 0.5 * Vec3d(box.upper);
    const double middle = glm::dot(a, center);
    const double half = glm::dot(glm::abs(a), Vec3d(box.upper) - center);
    return {middle - half, middle + half};
}

void check(const Vec3& direction, const Bounds3& bounds, float spacing, const Vec2& offset) {
    const float length = glm::length(direction);
    if (!(std::fabs(length - 1.0f) < 1e-3f))
        throw InputError("a ray-bundle's direction must have unit length");
    if (!(spacing > 0.0f) || !std::isfinite(spacing))
        throw InputError(
            fmt::format("the rays of a bundle must be a positive distance apart, not {} m", spacing));
    if (!bounds.empty() && !(is_finite(bounds.lower) && is_finite(bounds.upper)))
        throw InputError("the bounds of a ray-bundle are not finite");
    if (!(offset.x >= 0.0f && offset.x < 1.0f && offset.y >= 0.0f && offset.y < 1.0f))
        throw InputError("the offset of a ray-bundle's grid must lie in [0,1)^2");
}

}  // namespace

BundleGrid bundle_grid(const Vec3& direction, const Bounds3& bounds, float spacing, const Vec2& offset) {
    check(direction, bounds, spacing, offset);
    BundleGrid grid;
    const Frame frame(direction);
    grid.direction = direction, grid.right = frame.s, grid.up = frame.t, grid.spacing = spacing;
    if (bounds.empty()) return grid;
    const Extent x = extent_along(bounds, grid.right), y = extent_along(bounds, grid.up),
                 z = extent_along(bounds, grid.direction);
    // The first ray of a row is `offset` of a spacing before the bounds, the last one at most as far behind.
    const double step = double(spacing);
    const double columns = std::ceil(x.length() / step) + 2.0, rows = std::ceil(y.length() / step) + 2.0;
    if (!(columns * rows <= max_rays)) {
        const double fits = step * std::sqrt(columns * rows / max_rays) * 1.01;
        throw InputError(fmt::format("a ray-bundle of {} x {} rays is too large: a spacing of {:.3g} m fits",
                                     columns, rows, fits));
    }
    grid.columns = std::uint32_t(columns), grid.rows = std::uint32_t(rows);
    // Far enough before the bounds that rounding cannot put a surface behind the origin.
    const double before =
        z.lower - 0.01 * (x.length() + y.length() + z.length()) - step -
        1e-5 * double(max_component(glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper))));
    grid.origin =
        Vec3((x.lower - (0.5 + double(offset.x)) * step) * Vec3d(grid.right) +
             (y.lower - (0.5 + double(offset.y)) * step) * Vec3d(grid.up) + before * Vec3d(grid.direction));
    return grid;
}

float coincidence(const BundleGrid& grid, const Bounds3& bounds) {
    if (bounds.empty()) return 0.0f;
    const Vec3 farthest = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
    return 0x1p-22f * (glm::length(farthest) + glm::length(bounds.center() - grid.origin) + bounds.radius());
}

}  // namespace mote::gathering
