// The vertices of all light subpaths of a pass, ordered for merges with eye subpaths.
#pragma once

#include "core/geometry/ray_facing_discs.h"
#include "core/math/kd_tree.h"
#include "integrators/bidirectional/subpath.h"

namespace mote::integrators {

/// A vertex of a light subpath.
struct LightVertex {
    std::uint32_t path;   ///< index of the subpath
    std::uint32_t index;  ///< of the vertex in it, at least 1
};

/// Points on surfaces and in media, and the latter as discs that face query beams. All kernels are constant
/// within their radius.
class LightVertices {
  public:
    LightVertices() = default;
    /// Keeps a reference to the paths. Techniques without a radius get no structure, others the vertices
    /// that MergeSettings::sampled() leaves.
    LightVertices(const std::vector<Subpath>& paths, const MergeSettings& merging, core::Rng rng);

    /// Calls visit(LightVertex) for the vertices on surfaces, or in media, within `radius` [m] of p, in an
    /// order that depends on their positions alone.
    template <typename Visit>
    void for_each_near(bool on_surface, const core::Vec3& p, double radius,
                       std::vector<core::KdTree::Neighbour>& scratch, const Visit& visit) const {
        const Points& points = on_surface ? surface_ : volume_;
        points.tree.nearest(p, points.tree.size(), float(radius), scratch);
        for (const core::KdTree::Neighbour& n : scratch) visit(points.vertices[n.index]);
    }
    /// Calls visit(LightVertex, distance along the ray) for those in media that a query beam passes, by
    /// distance.
    template <typename Visit>
    void for_each_along(const core::Ray& ray, std::vector<core::RayFacingDiscs::Hit>& scratch,
                        const Visit& visit) const {
        discs_.hits(ray, scratch);
        for (const core::RayFacingDiscs::Hit& hit : scratch) visit(in_discs_[hit.index], hit.t);
    }

    const PathVertex& vertex(const LightVertex& v) const { return (*paths_)[v.path].vertices[v.index]; }
    const Subpath& path(const LightVertex& v) const { return (*paths_)[v.path]; }
    std::size_t on_surfaces() const { return on_surfaces_; }  ///< how many there are, sampled or not
    std::size_t in_media() const { return in_media_; }        ///< likewise

    /// Upper bound of what a vertex takes in all structures [B].
    static constexpr double bytes_per_vertex =
        double(sizeof(PathVertex) + 2 * sizeof(LightVertex) + core::KdTree::bytes_per_point +
               2 * sizeof(std::uint32_t) + 8 * sizeof(core::RayFacingDiscs::Disc));

  private:
    struct Points {
        std::vector<LightVertex> vertices;  ///< in the tree's order
        core::KdTree tree;
    };
    Points make_points(const std::vector<LightVertex>& vertices) const;

    const std::vector<Subpath>* paths_ = nullptr;
    Points surface_, volume_;
    core::RayFacingDiscs discs_;
    std::vector<LightVertex> in_discs_;
    std::size_t on_surfaces_ = 0, in_media_ = 0;
};

}  // namespace mote::integrators
