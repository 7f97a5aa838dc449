// The template bodies of majorant_grid.h.
#pragma once

#include "media/cell_walk.h"
#include "media/majorant_grid.h"

namespace mote::media {

namespace detail {
inline double largest(float v) { return v; }
inline double largest(const core::Rgb& v) { return core::max_component(v); }
inline std::int64_t floor_div(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }
}  // namespace detail

template <typename Value>
MajorantGrid<Value>::MajorantGrid(const Voxel& lower, const Voxel& upper, const Range& outside)
    : lower_(lower),
      upper_(upper),
      outside_(outside),
      outside_is_zero_(detail::largest(outside.upper) == 0.0) {
    const Voxel extent = glm::max(upper - lower, Voxel(1));
    const auto cells_along = [&](int axis) { return (extent[axis] + edge_ - 1) / edge_; };
    for (edge_ = 8;
         double(cells_along(0)) * double(cells_along(1)) * double(cells_along(2)) > double(max_cells);)
        edge_ *= 2;
    for (int axis = 0; axis < 3; ++axis) resolution_[axis] = int(cells_along(axis));
    const std::size_t count =
        std::size_t(resolution_.x) * std::size_t(resolution_.y) * std::size_t(resolution_.z);
    const float largest = std::numeric_limits<float>::max();
    cells_.assign(count, Range{Value(largest), Value(0.0f)});
    covered_.assign(count, 0.0);
}

template <typename Value>
template <typename Body>
void MajorantGrid<Value>::for_each_cell(const Voxel& block_lower, const Voxel& block_upper, Body&& body) {
    const Voxel lo = glm::max(block_lower, lower_), hi = glm::min(block_upper, upper_);
    if (lo.x > hi.x || lo.y > hi.y || lo.z > hi.z) return;
    // A voxel's hat function reaches less than one voxel to each side: the cells from (v - 1) to v, in cells.
    glm::ivec3 first, last;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t n = resolution_[axis] - 1;
        first[axis] =
            int(std::clamp<std::int64_t>(detail::floor_div(lo[axis] - lower_[axis] - 1, edge_), 0, n));
        last[axis] = int(std::clamp<std::int64_t>(detail::floor_div(hi[axis] - lower_[axis], edge_), 0, n));
    }
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const Voxel begin = lower_ + Voxel(x, y, z) * edge_;
                const Voxel support_lower = glm::max(lo, begin), support_upper = glm::min(hi, begin + edge_);
                body(cell_index(x, y, z), support_lower, support_upper);
            }
}

template <typename Value>
template <typename ValueAt>
void MajorantGrid<Value>::add_block(const Voxel& lower, const Voxel& upper, ValueAt&& value_at) {
    for_each_cell(lower, upper, [&](std::size_t cell, const Voxel& lo, const Voxel& hi) {
        Range& range = cells_[cell];
        Voxel v;
        for (v.z = lo.z; v.z <= hi.z; ++v.z)
            for (v.y = lo.y; v.y <= hi.y; ++v.y)
                for (v.x = lo.x; v.x <= hi.x; ++v.x) {
                    const Value value = value_at(v);
                    range.lower = glm::min(range.lower, value), range.upper = glm::max(range.upper, value);
                    covered_[cell] += 1.0;
                }
    });
}

template <typename Value>
void MajorantGrid<Value>::add_constant(const Voxel& lower, const Voxel& upper, const Value& value) {
    for_each_cell(lower, upper, [&](std::size_t cell, const Voxel& lo, const Voxel& hi) {
        if (lo.x > hi.x || lo.y > hi.y || lo.z > hi.z) return;
        cells_[cell].lower = glm::min(cells_[cell].lower, value);
        cells_[cell].upper = glm::max(cells_[cell].upper, value);
        const glm::dvec3 size = glm::dvec3(hi - lo) + 1.0;
        covered_[cell] += size.x * size.y * size.z;
    });
}

template <typename Value>
void MajorantGrid<Value>::finish(const Value& background) {
    for (int z = 0; z < resolution_.z; ++z)
        for (int y = 0; y < resolution_.y; ++y)
            for (int x = 0; x < resolution_.x; ++x) {
                const Voxel begin = lower_ + Voxel(x, y, z) * edge_, end = glm::min(begin + edge_, upper_);
                const glm::dvec3 size = glm::dvec3(end - begin) + 1.0;
                const std::size_t cell = cell_index(x, y, z);
                if (covered_[cell] >= size.x * size.y * size.z) continue;
                cells_[cell].lower = glm::min(cells_[cell].lower, background);
                cells_[cell].upper = glm::max(cells_[cell].upper, background);
            }
    covered_ = {};
    find_distances();
}

/// In two sweeps: each cell reads the neighbours that its sweep has met, which is exact for this distance.
template <typename Value>
void MajorantGrid<Value>::find_distances() {
    constexpr int most = 255;
    distance_.resize(cells_.size());
    for (std::size_t i = 0; i < cells_.size(); ++i)
        distance_[i] = detail::largest(cells_[i].upper) > 0.0 ? 0 : most;
    const auto inside = [&](const glm::ivec3& c) {
        return glm::all(glm::greaterThanEqual(c, glm::ivec3(0))) && glm::all(glm::lessThan(c, resolution_));
    };
    const auto look = [&](const glm::ivec3& cell, int sweep) {
        std::uint8_t& distance = distance_[cell_index(cell.x, cell.y, cell.z)];
        for (int n = 0; n < 13; ++n) {  // half of the 27 places around: -1 -1 -1 to -1 0 0
            const glm::ivec3 c = cell + sweep * glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            if (inside(c))
                distance = std::uint8_t(std::min<int>(distance, distance_[cell_index(c.x, c.y, c.z)] + 1));
        }
    };
    const glm::ivec3 n = resolution_;
    for (const int sweep : {1, -1})
        for (int z = 0; z < n.z; ++z)
            for (int y = 0; y < n.y; ++y)
                for (int x = 0; x < n.x; ++x)
                    look(sweep > 0 ? glm::ivec3(x, y, z) : n - 1 - glm::ivec3(x, y, z), sweep);
}

template <typename Value>
auto MajorantGrid<Value>::total() const -> Range {
    Range total = outside_;
    for (const Range& r : cells_)
        total.lower = glm::min(total.lower, r.lower), total.upper = glm::max(total.upper, r.upper);
    return total;
}

template <typename Value>
double MajorantGrid<Value>::certain_fraction() const {
    double lower = detail::largest(outside_.lower), upper = detail::largest(outside_.upper);
    if (!cells_.empty()) lower = upper = 0.0;
    for (const Range& r : cells_) lower += detail::largest(r.lower), upper += detail::largest(r.upper);
    return upper > 0.0 ? lower / upper : 1.0;
}

template <typename Value>
bool MajorantGrid<Value>::clip(const core::Vec3d& origin, const core::Vec3d& direction, double& t_begin,
                               double& t_end) const {
    return clip_with(origin, direction, 1.0 / direction, t_begin, t_end);
}

template <typename Value>
bool MajorantGrid<Value>::clip_with(const core::Vec3d& origin, const core::Vec3d& direction,
                                    const core::Vec3d& inverse, double& t_begin, double& t_end) const {
    for (int axis = 0; axis < 3; ++axis) {
        const double lo = double(lower_[axis]), hi = double(upper_[axis]);
        if (direction[axis] == 0.0) {
            if (origin[axis] < lo || origin[axis] > hi) return false;
            continue;
        }
        const double a = (lo - origin[axis]) * inverse[axis], b = (hi - origin[axis]) * inverse[axis];
        t_begin = std::max(t_begin, std::min(a, b)), t_end = std::min(t_end, std::max(a, b));
    }
    return t_begin < t_end;
}

template <typename Value>
template <typename Visit>
void MajorantGrid<Value>::walk(const core::Vec3d& origin, const core::Vec3d& direction, double t_begin,
                               double t_end, Visit&& visit) const {
    using detail::CellWalk;
    // Rarely needed, so that `visit` is compiled into the loop below and once for all that lies outside.
    const auto beyond = [&](double t0, double t1) __attribute__((noinline)) {
        return outside_is_zero_ || !(t0 < t1) || visit(outside_, t0, t1);
    };
    const core::Vec3d inverse = 1.0 / direction;
    double enter = t_begin, leave = t_end;
    if (!has_cells() || !clip_with(origin, direction, inverse, enter, leave)) {
        beyond(t_begin, t_end);
        return;
    }
    if (!beyond(t_begin, enter)) return;

    CellWalk walk(origin - core::Vec3d(lower_), direction, inverse, double(edge_), resolution_);
    walk.go_to(enter);
    const double last = std::min(leave, walk.end());  // a crossing from here on leaves the cells
    for (double t = enter;;) {
        const std::size_t cell = walk.cell();
        const Range& range = cells_[cell];
        const bool empty = detail::largest(range.upper) == 0.0;
        if (empty && distance_[cell] > shortest_leap) {
            t = walk.leap(distance_[cell] - 1);
            if (!(t < last)) break;
            walk.go_to(t);
            continue;
        }
        const double crossing = walk.next_crossing();
        const bool leaves = !(crossing < last);
        const double t_exit = leaves ? leave : crossing;
        if (t_exit > t) {
            if (!empty && !visit(range, t, t_exit)) return;
            t = t_exit;
        }
        if (leaves) break;
        walk.cross();
    }
    beyond(leave, t_end);
}

}  // namespace mote::media
