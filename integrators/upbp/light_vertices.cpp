#include "integrators/upbp/light_vertices.h"

namespace mote::integrators {

using namespace core;

LightVertices::LightVertices(const std::vector<Subpath>& paths, const MergeSettings& merging, Rng rng)
    : paths_(&paths) {
    std::vector<LightVertex> on_surfaces, in_media;
    const auto keep = [&](Merge technique, const LightVertex& v, std::vector<LightVertex>& kept) {
        if (merging.uses(technique) && merging.sampled(technique, rng)) kept.push_back(v);
    };
    for (std::size_t p = 0; p < paths.size(); ++p)
        for (std::size_t i = 1; i < paths[p].size(); ++i) {
            const PathVertex& vertex = paths[p].vertices[i];
            if (!vertex.scattering.connectable() || is_black(vertex.weight)) continue;
            const LightVertex v{std::uint32_t(p), std::uint32_t(i)};
            if (vertex.scattering.on_surface()) {
                ++on_surfaces_;
                keep(Merge::surface, v, on_surfaces);
            } else {
                ++in_media_;
                keep(Merge::point_point_3d, v, in_media);
                keep(Merge::point_beam_2d, v, in_discs_);
            }
        }
    surface_ = make_points(on_surfaces), volume_ = make_points(in_media);
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
