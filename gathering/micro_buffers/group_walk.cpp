#include "gathering/micro_buffers/group_walk.h"

#include <algorithm>

#include "gathering/micro_buffers/arc_tangent.h"
#include "gathering/micro_buffers/node_rules.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t width = ReceiverLanes::width;
/// A flat node that is seen at a slant counts as small as it looks, but not below this.
constexpr float min_slant = 0.25f;

class GroupWalk {
  public:
    GroupWalk(const PointHierarchy& hierarchy, const MicroBufferSettings& settings, const RayDirections& rays,
              std::span<const MicroReceiver> receivers)
        : hierarchy_(hierarchy), settings_(settings), rays_(rays), used_(std::uint32_t(receivers.size())) {
        for (std::uint32_t i = 0; i < width; ++i) {
            const MicroReceiver& r = receivers[std::min(i, used_ - 1)];
            lanes_.x[i] = r.position.x, lanes_.y[i] = r.position.y, lanes_.z[i] = r.position.z;
            for (int k = 0; k < 3; ++k)
                lanes_.s[k][i] = r.frame.s[k], lanes_.t[k][i] = r.frame.t[k], lanes_.n[k][i] = r.frame.n[k];
            lanes_.wake[i] = i < used_ ? 0u : 0xffffffffu;
        }
        const float side = float(settings.side);
        // A ball looks small below this r^2 / d^2 times d / z.
        threshold_ = settings.cut / (side * side);
        const float extent = hierarchy.nodes()[hierarchy.node_index(hierarchy.root())].radius;
        unit_ = extent > 0.0f ? std::ldexp(1.0f, -std::ilogb(extent)) : 1.0f;
    }

    void run(std::size_t stride, float* distances, std::uint32_t* hits) {
        for (NodePlace place = hierarchy_.root(); hierarchy_.exists(place);) {
            const std::uint32_t index = hierarchy_.node_index(place);
            const PointNode& node = hierarchy_.nodes()[index];
            const bool leaf = place.level == 0;
            const bool enter = decide(node, place);
            if (any_taken_) {
                project(node, leaf && !settings_.cast_leaves);
                for (std::uint32_t i = 0; i < used_; ++i)
                    if (taken_[i]) fill(node, index, i, {distances + i * stride, hits + i * stride});
            }
            place = enter ? place.first_child() : place.skip();
        }
    }

  private:
    /// Finds the lanes that take the node and those that are done with it; returns whether any must enter it.
    bool decide(const PointNode& node, const NodePlace& place) {
        const std::uint32_t begin = place.index << place.level, end = begin + (1u << place.level);
        const bool leaf = place.level == 0;
        const bool whole = node.cone_cos >= flat_cosine;
        const float unit = unit_, r = node.radius * unit, r2 = r * r, four_r2 = leaf ? 0.0f : 4.0f * r2;
        const float cone_sin = cone_sine(node);
        const float threshold = threshold_;
        std::int32_t any_enter = 0, any_taken = 0;
        MOTE_INDEPENDENT_LANES
        for (std::uint32_t i = 0; i < width; ++i) {
            const float x = (node.center.x - lanes_.x[i]) * unit, y = (node.center.y - lanes_.y[i]) * unit,
                        z = (node.center.z - lanes_.z[i]) * unit;
            const float d2 = fused_dot(x, y, z, x, y, z), d = std::sqrt(d2);
            const float up = fused_dot(x, y, z, lanes_.n[0][i], lanes_.n[1][i], lanes_.n[2][i]) + r;
            const float away = fused_dot(x, y, z, node.axis.x, node.axis.y, node.axis.z);
            const bool hidden = up <= 0.0f;
            const float slant = min_of(max_of(std::fabs(away) + cone_sin * d, min_slant * d), d);
            // r^2 / d^2 * slant / d against the threshold times d / up.
            const float size = r2 * slant * up, limit = threshold * d2 * d2;
            const bool small = leaf | (whole & (size <= limit) & (four_r2 < d2));
            const bool awake = lanes_.wake[i] <= begin;
            const bool taken = awake & !hidden & small, enter = awake & !hidden & !small;
            taken_[i] = taken, any_taken |= taken, any_enter |= enter;
            lanes_.wake[i] = (awake & !enter) ? end : lanes_.wake[i];
        }
        any_taken_ = any_taken != 0;
        return any_enter != 0;
    }

    /// Position of the node in each lane's frame, and the texels that it may reach.
    void project(const PointNode& node, bool one_texel) {
        const float side = float(rays_.side), half = 0.5f * side;
        const float after_x = 1.0f - settings_.place.x, after_y = 1.0f - settings_.place.y;
        // Nodes that subtend a large angle may reach any texel.
        const float per_angle = one_texel ? 0.0f : square_reach * side, beside = one_texel ? 0.49f : 0.02f;
        const float largest = one_texel ? infinity : 0.5f;
        const float per_slope = one_texel ? 0.0f : half;
        const PointNode n = node;
        MOTE_INDEPENDENT_LANES
        for (std::uint32_t i = 0; i < width; ++i) {
            const float x = n.center.x - lanes_.x[i], y = n.center.y - lanes_.y[i],
                        z = n.center.z - lanes_.z[i];
            const float cx = fused_dot(x, y, z, lanes_.s[0][i], lanes_.s[1][i], lanes_.s[2][i]);
            const float cy = fused_dot(x, y, z, lanes_.t[0][i], lanes_.t[1][i], lanes_.t[2][i]);
            const float cz = fused_dot(x, y, z, lanes_.n[0][i], lanes_.n[1][i], lanes_.n[2][i]);
            cx_[i] = cx, cy_[i] = cy, cz_[i] = cz;
            ax_[i] = fused_dot(n.axis.x, n.axis.y, n.axis.z, lanes_.s[0][i], lanes_.s[1][i], lanes_.s[2][i]);
            ay_[i] = fused_dot(n.axis.x, n.axis.y, n.axis.z, lanes_.t[0][i], lanes_.t[1][i], lanes_.t[2][i]);
            az_[i] = fused_dot(n.axis.x, n.axis.y, n.axis.z, lanes_.n[0][i], lanes_.n[1][i], lanes_.n[2][i]);
        }
        MOTE_INDEPENDENT_LANES
        for (std::uint32_t i = 0; i < width; ++i) {
            const float cx = cx_[i], cy = cy_[i], cz = cz_[i], flat2 = cx * cx + cy * cy;
            const float over_d = 1.0f / max_of(std::sqrt(flat2 + cz * cz), 1e-30f);
            // hemisphere_to_square(): the disc, then the concentric square.
            const float up = max_of(cz, 0.0f) * over_d;
            const float radius = min_of(std::sqrt(flat2) * over_d, 1.0f);
            const float ax = std::fabs(cx), ay = std::fabs(cy), longer = max_of(ax, ay);
            const float across =
                radius * (4.0f * inv_pi) * arc_tangent(min_of(ax, ay) / max_of(longer, 1e-30f));
            const float px = half + half * std::copysign(ax < ay ? across : radius, cx);
            const float py = half + half * std::copysign(ax < ay ? radius : across, cy);
            const float angle = n.radius * over_d;
            const float any = angle < largest ? per_angle * angle : side;
            // Along the longer coordinate, the distance from the middle, by the slope of sin anywhere in the
            // ball, unless the ball may reach a diagonal, where coordinates change roles.
            const float wide = 1.05f * angle;  // its arc sine, up to a half
            const float outwards = per_slope * wide * min_of(up + wide, 1.0f);
            const float room = half * (radius - across) - any;
            const float reach = beside + any, narrow = beside + (room > outwards ? outwards : any);
            const float reach_x = ax < ay ? reach : narrow, reach_y = ax < ay ? narrow : reach;
            // Rays are at i + place: the first at or after px - reach, and the one after the last.
            x0_[i] = std::int32_t(max_of(px - reach_x + after_x, 0.0f));
            y0_[i] = std::int32_t(max_of(py - reach_y + after_y, 0.0f));
            x1_[i] = std::int32_t(min_of(px + reach_x + after_x, side));
            y1_[i] = std::int32_t(min_of(py + reach_y + after_y, side));
        }
    }

    void fill(const PointNode& node, std::uint32_t index, std::uint32_t i, DepthRows out) {
        const LocalDisc disc{
            {cx_[i], cy_[i], cz_[i]}, {ax_[i], ay_[i], az_[i]}, node.radius, near_back * node.radius, index};
        fill_box(rays_, disc, {x0_[i], y0_[i], x1_[i], y1_[i]}, out);
    }

    const PointHierarchy& hierarchy_;
    const MicroBufferSettings& settings_;
    const RayDirections& rays_;
    std::uint32_t used_;
    float threshold_;
    float unit_;  ///< power of two that brings lengths near 1, since fourth powers of them are compared
    ReceiverLanes lanes_;
    bool any_taken_ = false;
    alignas(64) std::int32_t taken_[width];
    alignas(64) float cx_[width], cy_[width], cz_[width], ax_[width], ay_[width], az_[width];
    alignas(64) std::int32_t x0_[width], y0_[width], x1_[width], y1_[width];
};

}  // namespace

void walk_group(const PointHierarchy& hierarchy, const MicroBufferSettings& settings,
                const RayDirections& rays, std::span<const MicroReceiver> receivers, std::size_t stride,
                float* distances, std::uint32_t* hits) {
    if (hierarchy.empty() || receivers.empty()) return;
    GroupWalk(hierarchy, settings, rays, receivers).run(stride, distances, hits);
}

}  // namespace mote::gathering
