#include "gathering/eye_bundles/imperfect_links.h"

#include "core/math/random.h"

namespace mote::gathering {

using namespace core;

ImperfectLinks::ImperfectLinks(ShapeSpan shapes, const ImperfectLinkSettings& settings)
    : shapes_(shapes),
      settings_(settings),
      surfaces_(surface_triangles(shapes)),
      imperfect_(surfaces_, settings.points) {
    const float radius = surfaces_.bounds.empty() ? 1.0f : surfaces_.bounds.radius();
    spacing_ = std::max(radius / 128.0f, 1e-30f);
    reach_ = spacing_ + float(imperfect_.disc_radius({.splat_size = settings.splat_size}));
}

RayBundle ImperfectLinks::bundle(const Vec3& direction, std::uint64_t number, std::size_t bundles,
                                 CancelToken cancelled) const {
    Rng rng(hash_keys(number, 0x6c696e6bull));
    const BundleGrid grid = bundle_grid(direction, surfaces_.bounds, spacing_, rng.next_vec2());
    ImperfectSettings s;
    s.splat_size = settings_.splat_size, s.cancelled = cancelled;
    s.memory_budget = settings_.memory_budget / std::max<std::size_t>(bundles, 1);
    return imperfect_.trace(grid, number, s);
}

SurfaceHit ImperfectLinks::place(const BundleHit& hit) const {
    SurfaceHit place = surface_place(surfaces_, shapes_, hit.index(), Vec2(hit.u(), hit.v()));
    // Shadow rays meet the shape itself, whose triangles may lie below it.
    const Vec3 outside = hit.from_behind() ? -place.geometric_normal : place.geometric_normal;
    place.position += depth_below(*place.shape) * outside;
    return place;
}

std::optional<LinkEnd> ImperfectLinks::next(const RayBundle& bundle, const ScatteringVertex& x,
                                            const Vec3& w) const {
    const BundleGrid& grid = bundle.grid;
    const Vec3 at = x.position - grid.origin;
    const float column = glm::dot(at, grid.right) / grid.spacing, row = glm::dot(at, grid.up) / grid.spacing;
    if (!(column >= 0.0f && row >= 0.0f && column < float(grid.columns) && row < float(grid.rows)))
        return std::nullopt;
    const auto hits = bundle.hits_of(std::size_t(row) * grid.columns + std::size_t(column));
    const Vec3& n = x.hit.geometric_normal;
    const bool along = glm::dot(w, grid.direction) > 0.0f, leaves_front = glm::dot(n, w) > 0.0f;
    // The ray's hit of x's surface: that side, as far off as the slope makes of the way across.
    const float cosine = std::fmax(std::fabs(glm::dot(n, w)), 0.05f);
    const float tolerance = reach_ * (std::sqrt(std::fmax(0.0f, 1.0f - sqr(cosine))) / cosine + 0.1f);
    const float distance = glm::dot(at, grid.direction);
    std::size_t near = hits.size();
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const float off = std::fabs(hits[i].distance - distance);
        if (hits[i].from_behind() != (leaves_front == along) || off > tolerance) continue;
        if (near == hits.size() || off < std::fabs(hits[near].distance - distance)) near = i;
    }
    if (near == hits.size()) return std::nullopt;
    if (along ? near + 1 == hits.size() : near == 0) return LinkEnd{};
    const BundleHit& far = hits[along ? near + 1 : near - 1];
    return LinkEnd{place(far), std::fabs(far.distance - hits[near].distance)};
}

}  // namespace mote::gathering
