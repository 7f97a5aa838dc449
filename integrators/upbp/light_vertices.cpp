#include "integrators/upbp/light_vertices.h"

namespace mote::integrators {

using namespace core;

LightVertices::LightVertices(const std::vector<Subpath>& paths, const MergeSettings& merging)
    : paths_(&paths) {
    std::vector<LightVertex> surface;
    for (std::size_t p = 0; p < paths.size(); ++p)
        for (std::size_t i = 1; i < paths[p].size(); ++i) {
            const PathVertex& v = paths[p].vertices[i];
            if (!v.scattering.connectable() || is_black(v.weight)) continue;
            (v.scattering.on_surface() ? surface : in_discs_).push_back({std::uint32_t(p), std::uint32_t(i)});
        }
    on_surfaces_ = surface.size();
    if (merging.uses(Merge::surface)) surface_ = make_points(surface);
    if (merging.uses(Merge::point_point_3d)) volume_ = make_points(in_discs_);
    if (!merging.uses(Merge::point_beam_2d)) return;
    const auto radius = float(merging.radius[std::size_t(Merge::point_beam_2d)]);
    std::vector<RayFacingDiscs::Disc> discs;
    discs.reserve(in_discs_.size());
    for (const LightVertex& v : in_discs_) discs.push_back({vertex(v).scattering.position, radius});
    discs_.build(std::move(discs));
}

LightVertices::Points LightVertices::make_points(const std::vector<LightVertex>& vertices) const {
    std::vector<Vec3> positions;
    positions.reserve(vertices.size());
    for (const LightVertex& v : vertices) positions.push_back(vertex(v).scattering.position);
    Points points;
    points.tree = KdTree(positions);
    points.vertices.reserve(vertices.size());
    for (const std::uint32_t i : points.tree.order()) points.vertices.push_back(vertices[i]);
    points.tree.forget_order();
    return points;
}

}  // namespace mote::integrators
