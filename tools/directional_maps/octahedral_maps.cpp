// The octahedral maps behind the interface (Engelhardt 2013, Ch. 7).

#include "lights/directional_maps/octahedral_map.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "tools/directional_maps/directional_map_kinds.h"
#include "tools/directional_maps/texel_solid_angle.h"

namespace mote::tools {

using namespace core;
using namespace lights;

namespace {

/// All directions on one square. With up other than 1, the octants as cameras along (1, 1, up) see them.
class SquareOctahedral : public DirectionalMap {
  public:
    SquareOctahedral(int size, float up) : DirectionalMap(1, size, size), map_{size}, up_(up) {}

    MapPoint project(const Vec3& d) const override { return {0, map_.uv(Vec3(d.x, d.y, up_ * d.z))}; }
    Vec3 unproject(const MapPoint& p) const override {
        const Vec3 d = octahedral_unproject(2.0f * p.uv - 1.0f);
        return up_ == 1.0f ? d : glm::normalize(Vec3(d.x, d.y, d.z / up_));
    }
    double solid_angle(int texel) const override {
        const Place p = place(texel);
        const auto corner = [&](int di, int dj) {
            return 2.0 / double(map_.size) * glm::dvec2(p.i + di, p.j + dj) - 1.0;
        };
        return octahedral_polygon(std::array{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)},
                                  double(up_));
    }

  protected:
    void add_beyond_edge(FilterTaps& taps, const Place& p, float weight) const override {
        taps.add(map_.folded(p.i, p.j), weight);
    }

  private:
    OctahedralMap map_;
    float up_;
};

/// Solid angle of a texel of a hemisphere's square [sr]: turned back by 45 degrees, its corners lie on the
/// unfolded octahedron.
double hemisphere_texel(int size, int i, int j) {
    const auto corner = [&](int di, int dj) {
        const glm::dvec2 q = 2.0 / double(size) * glm::dvec2(i + di, j + dj) - 1.0;
        return 0.5 * glm::dvec2(q.x + q.y, q.y - q.x);
    };
    return octahedral_polygon(std::array{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}, 1.0);
}

/// The upper hemisphere on the left, the lower one on the right. As printed, Eq. 7.3 lets opposite directions
/// meet in the middle. Here the lower square runs the other way along x, so that the middle is
/// continuous, and so is the wrap from right to left (docs/errata.md).
class RectangleOctahedral : public DirectionalMap {
  public:
    explicit RectangleOctahedral(int size) : DirectionalMap(1, 2 * size, size) {}

    MapPoint project(const Vec3& d) const override {
        const Vec2 q = hemi_octahedral_project(d);
        return {0, {d.z >= 0.0f ? 0.25f * q.x + 0.25f : 0.75f - 0.25f * q.x, 0.5f * q.y + 0.5f}};
    }
    Vec3 unproject(const MapPoint& p) const override {
        const bool upper = p.uv.x <= 0.5f;
        const float x = upper ? 4.0f * p.uv.x - 1.0f : 3.0f - 4.0f * p.uv.x;
        const Vec3 d = hemi_octahedral_unproject({x, 2.0f * p.uv.y - 1.0f});
        return {d.x, d.y, upper ? d.z : -d.z};
    }
    double solid_angle(int texel) const override {
        const Place p = place(texel);
        return hemisphere_texel(height(), p.i < height() ? p.i : width() - 1 - p.i, p.j);
    }

  protected:
    void add_beyond_edge(FilterTaps& taps, const Place& p, float weight) const override {
        // The upper and the lower edge meet themselves, mirrored at the middle of the map.
        const bool beyond = p.j < 0 || p.j >= height();
        const int i = (beyond ? width() - 1 - p.i : p.i) + width();
        taps.add(index({0, i % width(), std::clamp(p.j, 0, height() - 1)}), weight);
    }
};

class HemiOctahedral : public DirectionalMap {
  public:
    explicit HemiOctahedral(int size) : DirectionalMap(1, size, size), map_{size} {}

    double domain() const override { return 0.5 * DirectionalMap::domain(); }
    MapPoint project(const Vec3& d) const override { return {0, map_.uv(d)}; }
    Vec3 unproject(const MapPoint& p) const override { return hemi_octahedral_unproject(2.0f * p.uv - 1.0f); }
    double solid_angle(int texel) const override {
        const Place p = place(texel);
        return hemisphere_texel(map_.size, p.i, p.j);
    }

  protected:
    void add_beyond_edge(FilterTaps& taps, const Place& p, float weight) const override {
        taps.add(index({0, std::clamp(p.i, 0, map_.size - 1), std::clamp(p.j, 0, map_.size - 1)}), weight);
    }

  private:
    HemiOctahedralMap map_;
};

}  // namespace

std::unique_ptr<DirectionalMap> make_square_octahedral_map(int size) {
    return std::make_unique<SquareOctahedral>(size, 1.0f);
}
std::unique_ptr<DirectionalMap> make_rectangle_octahedral_map(int size) {
    return std::make_unique<RectangleOctahedral>(size);
}
std::unique_ptr<DirectionalMap> make_hemi_octahedral_map(int size) {
    return std::make_unique<HemiOctahedral>(size);
}
std::unique_ptr<DirectionalMap> make_perspective_octahedral_map(int size, float up) {
    if (!(up >= 0.01f && up <= 100.0f))
        throw InputError(
            fmt::format("a perspective octahedral map with up = {}: it must be from 0.01 to 100", up));
    return std::make_unique<SquareOctahedral>(size, up);
}

}  // namespace mote::tools
