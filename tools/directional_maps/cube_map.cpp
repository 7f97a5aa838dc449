// Six squares: what cameras of 90 degrees see along the axes (Greene 1986; Engelhardt 2013, Sec. 5.1.3).

#include <algorithm>

#include "tools/directional_maps/directional_map_kinds.h"
#include "tools/directional_maps/texel_solid_angle.h"

namespace mote::tools {

using namespace core;

namespace {

/// Face 2 a looks along the positive axis a, face 2 a + 1 along the negative one. Columns run along the axis
/// after a, rows along the one after that.
class CubeMap : public DirectionalMap {
  public:
    explicit CubeMap(int size) : DirectionalMap(6, size, size) {}

    MapPoint project(const Vec3& d) const override {
        const Vec3 a = glm::abs(d);
        const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
        const float scale = 0.5f / a[axis];
        return {2 * axis + int(d[axis] < 0.0f),
                {scale * d[(axis + 1) % 3] + 0.5f, scale * d[(axis + 2) % 3] + 0.5f}};
    }
    Vec3 unproject(const MapPoint& p) const override {
        const int axis = p.face / 2;
        Vec3 d;
        d[axis] = p.face % 2 == 0 ? 1.0f : -1.0f;
        d[(axis + 1) % 3] = 2.0f * p.uv.x - 1.0f;
        d[(axis + 2) % 3] = 2.0f * p.uv.y - 1.0f;
        return glm::normalize(d);
    }
    double solid_angle(int texel) const override {
        const Place p = place(texel);
        const double edge = 2.0 / double(width());
        const glm::dvec2 low = edge * glm::dvec2(p.i, p.j) - 1.0,
                         high = edge * glm::dvec2(p.i + 1, p.j + 1) - 1.0;
        return cube_rectangle({low, high});
    }

  protected:
    void add_beyond_edge(FilterTaps& taps, const Place& p, float weight) const override {
        const int i = std::clamp(p.i, 0, width() - 1), j = std::clamp(p.j, 0, height() - 1);
        if (i == p.i || j == p.j) {
            DirectionalMap::add_beyond_edge(taps, p, weight);
            return;
        }
        // Only three faces meet in a corner: the fourth value continues them linearly.
        DirectionalMap::add_beyond_edge(taps, {p.face, p.i, j}, weight);
        DirectionalMap::add_beyond_edge(taps, {p.face, i, p.j}, weight);
        taps.add(index({p.face, i, j}), -weight);
    }
};

}  // namespace

std::unique_ptr<DirectionalMap> make_cube_map(int size) { return std::make_unique<CubeMap>(size); }

}  // namespace mote::tools
