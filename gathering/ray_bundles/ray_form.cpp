#include "gathering/ray_bundles/ray_form.h"

#include <algorithm>
#include <bit>

#include "gathering/ray_bundles/grid_steps.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t side = RayForm::packet_side;
constexpr int width = ShadowPacket::width;

/// Origins are rounded to single precision, and so is each step of Embree's box test: some 2^-22 of the
/// coordinates and distances. Eight times that costs next to nothing.
float margin_of(const Bounds3& bounds) {
    const float reach = max_component(glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper)));
    return bounds.empty() ? 0.0f : 0x1p-19f * (reach + glm::length(bounds.diagonal()));
}

std::vector<Bounds3> boxes_of(const SurfaceTriangles& triangles, float margin) {
    std::vector<Bounds3> boxes(triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (const Vec3& corner : triangles.corners[i]) boxes[i].extend(corner);
        boxes[i].lower -= Vec3(margin), boxes[i].upper += Vec3(margin);
    }
    return boxes;
}

/// Packets of one grid, which begin shortly before the bounds.
class PacketMaker {
  public:
    PacketMaker(const BundleGrid& grid, const Bounds3& bounds, float margin) : grid_(grid) {
        packet_.clear();
        const Vec3d d(grid.direction),
            to_center = 0.5 * (Vec3d(bounds.lower) + Vec3d(bounds.upper)) - Vec3d(grid.origin);
        const double reach =
            0.5 * glm::length(Vec3d(bounds.upper) - Vec3d(bounds.lower)) + 4.0 * double(margin);
        const double middle = glm::dot(to_center, d) / glm::dot(d, d);
        start_ = Vec3d(grid.origin) + std::max(0.0, middle - reach) * d;
        length_ = float(2.0 * reach * 1.001);
    }
    const ShadowPacket& at(std::uint32_t x0, std::uint32_t y0, std::uint32_t end_row) {
        const double step = double(grid_.spacing);
        for (int lane = 0; lane < width; ++lane) {
            const std::uint32_t x = x0 + std::uint32_t(lane) % side, y = y0 + std::uint32_t(lane) / side;
            const Vec3d origin = start_ + (double(x) + 0.5) * step * Vec3d(grid_.right) +
                                 (double(y) + 0.5) * step * Vec3d(grid_.up);
            packet_.set(lane, Vec3(origin), grid_.direction,
                        x < grid_.columns && y < end_row ? length_ : -infinity);
        }
        return packet_;
    }

  private:
    const BundleGrid& grid_;
    ShadowPacket packet_;
    Vec3d start_;
    float length_;
};

/// True if the boxes of the triangle and of the packet at (x0, y0) meet on the grid.
bool may_hit(const std::array<Vec3d, 3>& p, double x0, double y0) {
    constexpr double last = side - 1;
    return lowest_of(p[0].x, p[1].x, p[2].x) <= x0 + last && highest_of(p[0].x, p[1].x, p[2].x) >= x0 &&
           lowest_of(p[0].y, p[1].y, p[2].y) <= y0 + last && highest_of(p[0].y, p[1].y, p[2].y) >= y0;
}

/// The values of the edges at each ray of a packet.
struct PacketValues {
    double v[3][width];
};

/// Bit i: does ray i of the packet at (x0, y0) hit the triangle?
std::uint32_t lanes_hit(const ProjectedTriangle& triangle, double x0, double y0, PacketValues& values) {
    std::uint32_t left[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const ProjectedEdge& edge = triangle.edge(i);
        double columns[side];
        for (std::uint32_t x = 0; x < side; ++x) columns[x] = edge.column(x0 + double(x));
        for (std::uint32_t y = 0; y < side; ++y) {
            const double row = edge.row(y0 + double(y));
            for (std::uint32_t x = 0; x < side; ++x) values.v[i][y * side + x] = row - columns[x];
        }
        left[i] = ProjectedEdge::bits(values.v[i]);
        if (edge.flipped()) left[i] = ~left[i];
    }
    return (left[0] & left[1] & left[2]) | ~(left[0] | left[1] | left[2]);
}

}  // namespace

RayForm::RayForm(const SurfaceTriangles& triangles, const Bounds3& bounds)
    : triangles_(triangles),
      bounds_(bounds),
      margin_(margin_of(bounds)),
      boxes_(boxes_of(triangles, margin_)) {}

void RayForm::trace_rows(const BundleGrid& grid, std::uint32_t begin, std::uint32_t end,
                         HitBand& band) const {
    const BundleProjection projection(grid);
    PacketMaker packets(grid, bounds_, margin_);
    for (std::uint32_t x0 = 0; x0 < grid.columns; x0 += side)
        boxes_.for_each_box(packets.at(x0, begin, end), [&](std::uint32_t index, std::uint32_t lanes) {
            const auto corners = project(projection, triangles_.corners[index]);
            if (!may_hit(corners, double(x0), double(begin))) return;
            const ProjectedTriangle triangle(corners);
            PacketValues values;
            for (lanes &= lanes_hit(triangle, double(x0), double(begin), values); lanes != 0;
                 lanes &= lanes - 1) {
                const auto lane = std::uint32_t(std::countr_zero(lanes));
                const std::uint32_t x = x0 + lane % side, row = lane / side;
                const auto hit = triangle.make_hit(double(x), double(begin + row), values.v[0][lane],
                                                   values.v[1][lane], values.v[2][lane], index);
                if (hit) band.add(row * grid.columns + x, *hit);
            }
        });
}

}  // namespace mote::gathering
