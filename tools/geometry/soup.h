// Triangles without order, and the shapes that the generated scenes are put together from: boxes, sheets,
// lathes.
//
// Faces are counter-clockwise seen from outside. Positions are metres with y up. What makes an indexed mesh
// with normals of them is in mesh.h.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace mote::tools {

using core::Vec2;
using core::Vec3;

/// Where a part is put: scaled, turned about the upright axis (radians, counter-clockwise from above), moved.
struct Placement {
    Vec3 origin{0.0f};
    float turn = 0.0f, scale = 1.0f;

    Vec3 operator()(const Vec3& p) const;
};

class Soup {
  public:
    void triangle(const Vec3& a, const Vec3& b, const Vec3& c) { triangles_.push_back({a, b, c}); }
    void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
    /// Eight corners: bit 0 of the index is the far side along the first axis, bit 1 along the second, bit 2
    /// along the third; the axes form a right-handed frame.
    void hexahedron(const std::array<Vec3, 8>& corners);
    void box(const Vec3& lower, const Vec3& upper);
    /// A sheet of nu x nv quads over the unit square, facing dp/du x dp/dv.
    void sheet(int nu, int nv, const std::function<Vec3(float u, float v)>& point);
    /// A profile of (radius, height) from bottom to top, turned about the upright axis through `foot`.
    void lathe(const Vec3& foot, const std::vector<Vec2>& profile, int segments);
    /// Turns a profile whose radius may depend on the angle; `t` in [0, 1] runs along the profile.
    void lathe(const Vec3& foot, int rings, int segments,
               const std::function<Vec2(float t, float angle)>& profile);
    /// A profile of (outwards, height) along the four sides of an upright rectangle; outwards is away from
    /// its middle, or towards it when `inwards`. The face looks the same way.
    void frame(const Vec3& lower, const Vec3& upper, const std::vector<Vec2>& profile, bool inwards);

    void add(const Soup& part, const Placement& placement);

    std::size_t size() const { return triangles_.size(); }
    const std::vector<std::array<Vec3, 3>>& triangles() const { return triangles_; }

  private:
    std::vector<std::array<Vec3, 3>> triangles_;
};

/// A scene by materials: one soup each.
using Parts = std::map<std::string, Soup>;
void add_parts(Parts& all, const Parts& part, const Placement& placement);

/// Counts of segments: `n` at detail 1, never below `least`.
int segments(float n, float detail, int least = 3);

}  // namespace mote::tools
