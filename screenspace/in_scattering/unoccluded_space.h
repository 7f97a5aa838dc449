// Tests whether anything reaches into a triangle of space. If not, no ray within it is stopped, and none of
// them has to be traced.
//
// A tree of boxes over the triangles of meshes and the bounds of all other shapes; against it, the triangle
// by separating axes (Akenine-Moller 2001). One-sided: `clear` is certain, with room for the rounding of
// shadow rays; touching, or nearly, is not clear. The ray tracer has no such query: Embree's point queries
// find spheres.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace mote::screenspace {

class UnoccludedSpace {
  public:
    /// Surfaces and boundaries of media apart. Keeps references to the shapes. Memory: about 25
    /// bytes a triangle.
    explicit UnoccludedSpace(std::span<const std::shared_ptr<core::Shape>> shapes);

    using Triangle = std::array<core::Vec3d, 3>;
    /// True if nothing that stops shadow rays reaches into the triangle.
    bool free_of_surfaces(const Triangle& t) const { return surfaces_.clear(t); }
    /// True if no boundary between media reaches into the triangle: all of it is in one medium.
    bool free_of_boundaries(const Triangle& t) const { return boundaries_.clear(t); }
    /// Both for the space between a point and an infinite ray that starts at `from`.
    bool free_of_surfaces(const core::Vec3d& point, const core::Vec3d& from,
                          const core::Vec3d& direction) const;
    bool free_of_boundaries(const core::Vec3d& point, const core::Vec3d& from,
                            const core::Vec3d& direction) const;

    std::size_t memory_bytes() const { return surfaces_.memory_bytes() + boundaries_.memory_bytes(); }

  private:
    class Tree {
      public:
        void add(const core::Shape& shape);
        void build();
        bool clear(const Triangle& t) const;
        bool clear(const core::Vec3d& point, const core::Vec3d& from, const core::Vec3d& direction) const;
        std::size_t memory_bytes() const {
            return nodes_.capacity() * sizeof(Node) + parts_.capacity() * sizeof(Part);
        }

      private:
        struct Part {  ///< a triangle of a mesh, or all of another shape
            std::uint32_t shape, triangle;
        };
        struct Node {
            core::Bounds3 bounds;
            std::uint32_t first, count;  ///< count 0: children are the next node and `first`
        };
        class Query;
        struct Entry;  ///< a part while the tree is built
        void split(std::vector<Entry>& entries, std::uint32_t node, std::size_t begin, std::size_t end);
        core::Bounds3 bounds_of(const Part& part) const;
        bool apart(const Query& query, const Part& part) const;

        std::vector<const core::Shape*> shapes_;
        std::vector<const core::MeshData*> meshes_;  ///< of the shape, or null
        std::vector<Part> parts_;
        std::vector<Node> nodes_;
        double largest_ = 0.0;  ///< coordinate
    };
    Tree surfaces_, boundaries_;
};

}  // namespace mote::screenspace
