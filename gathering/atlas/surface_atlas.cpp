#include "gathering/atlas/surface_atlas.h"

#include "gathering/atlas/atlas_builder.h"

namespace mote::gathering {

using namespace core;

SurfaceAtlas::SurfaceAtlas(const SurfaceTriangles& surfaces, ShapeSpan shapes, const AtlasSettings& settings)
    : surfaces_(&surfaces), shapes_(shapes) {
    AtlasBuilder(*this, settings).build();
}

std::size_t SurfaceAtlas::memory_bytes() const {
    return cells_of_.capacity() * sizeof(TriangleCells) + cells_.capacity() * sizeof(std::uint32_t) +
           texels_.capacity() * sizeof(AtlasTexel);
}

std::optional<SurfaceAtlas::Blend> SurfaceAtlas::blend(std::uint32_t triangle, float u, float v,
                                                       SurfaceSide side) const {
    const TriangleCells& c = cells_of_[triangle];
    const std::uint32_t base = c.base[std::size_t(side)];
    if (base == none) return std::nullopt;
    const Vec2 last(c.last_x, c.last_y);
    // Half a cell beyond the outermost middles: up to the border what is linear stays so.
    const Vec2 at = glm::clamp(c.corner + u * c.edge_u + v * c.edge_v - 0.5f, Vec2(-0.5f), last + 0.5f);
    const Vec2 low = glm::clamp(glm::floor(at), Vec2(0.0f), glm::max(last - 1.0f, Vec2(0.0f)));
    const Vec2 high = glm::min(low + 1.0f, last), f = at - low;
    const auto texel = [&](float x, float y) {
        return base + cells_[c.cells + std::uint32_t(y) * (std::uint32_t(c.last_x) + 1) + std::uint32_t(x)];
    };
    return Blend{{texel(low.x, low.y), texel(high.x, low.y), texel(low.x, high.y), texel(high.x, high.y)},
                 {(1 - f.x) * (1 - f.y), f.x * (1 - f.y), (1 - f.x) * f.y, f.x * f.y}};
}

std::array<Vec2, 2> SurfaceAtlas::cell_steps(std::uint32_t triangle) const {
    const Vec2 a = cells_of_[triangle].edge_u, b = cells_of_[triangle].edge_v;
    const float determinant = a.x * b.y - a.y * b.x;
    if (determinant == 0.0f) return {Vec2(0.0f), Vec2(0.0f)};
    return {Vec2(b.y, -a.y) / determinant, Vec2(-b.x, a.x) / determinant};
}

}  // namespace mote::gathering
