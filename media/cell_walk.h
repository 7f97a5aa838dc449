// The walk of a ray through cubic cells (Amanatides & Woo 1987), on all axes at once.
//
// Which face comes next is a matter of chance, so nothing branches on the axis: four lanes of a vector, the
// last one idle. The t of every crossing is computed from its face's whole number: nothing accumulates. A ray
// that meets two faces at once crosses both.
#pragma once

#include <cstdint>
#include <limits>

#include "core/math/vec.h"

namespace mote::media::detail {

// GCC's and Clang's vectors, for any processor.
using Vec4d = double __attribute__((vector_size(32)));
using Vec4l = std::int64_t __attribute__((vector_size(32)));
using Vec4i = std::int32_t __attribute__((vector_size(16)));

class CellWalk {
  public:
    /// `origin` relative to the cells' corner; `inverse` is 1 / direction; all in voxels, `edge` of them to a
    /// cell.
    CellWalk(const core::Vec3d& origin, const core::Vec3d& direction, const core::Vec3d& inverse, double edge,
             const glm::ivec3& resolution) {
        const double to_cells = 1.0 / edge;
        const Vec4d zero{};
        offset_ = Vec4d{origin.x, origin.y, origin.z, 0.0} * to_cells;
        direction_ = Vec4d{direction.x, direction.y, direction.z, 0.0} * to_cells;
        parallel_ = direction_ == zero;
        inverse_ = parallel_ ? zero : Vec4d{inverse.x, inverse.y, inverse.z, 0.0} * edge;
        const Vec4d count = {double(resolution.x), double(resolution.y), double(resolution.z), 1.0};
        up_ = direction_ > zero ? zero + 1.0 : zero;
        step_ = up_ + up_ - 1.0;
        last_cell_ = count - 1.0;
        set_t_of(direction_ > zero ? count : zero, next_);
        end_ = least(next_);
        const std::int64_t row = resolution.x, slice = row * resolution.y;
        stride_ = Vec4l{1, row, slice, 0};
        signed_stride_ = direction_ > zero ? stride_ : -stride_;
    }

    /// The t at which the ray leaves the cells.
    double end() const { return end_; }
    /// Starts or continues at t.
    void go_to(double t) {
        const Vec4d zero{}, place = offset_ + t * direction_;
        const Vec4d inside = place > zero ? (place < last_cell_ ? place : last_cell_) : zero;
        const Vec4i whole = __builtin_convertvector(inside, Vec4i);
        const Vec4l cell = __builtin_convertvector(whole, Vec4l) * stride_;
        index_ = cell[0] + cell[1] + cell[2];
        border_ = __builtin_convertvector(whole, Vec4d) + up_;
        set_t_of(border_, next_), set_t_of(border_ + step_, after_);
        crossing_ = least(next_);
    }
    /// Place of the cell in an array with x fastest.
    std::size_t cell() const { return std::size_t(index_); }
    /// The t at which the ray leaves the cell.
    double next_crossing() const { return crossing_; }
    /// Goes to the cell behind that.
    void cross() {
        const Vec4d zero{};
        const Vec4l here = next_ == zero + crossing_, steps = here & signed_stride_;
        index_ += steps[0] + steps[1] + steps[2];
        next_ = here ? after_ : next_;
        border_ += here ? step_ : zero;
        crossing_ = least(next_);
        set_t_of(border_ + step_, after_);
    }
    /// The t at which the ray has left all cells that lie at most `cells` beside this one.
    double leap(int cells) const {
        Vec4d t;
        set_t_of(border_ + double(cells) * step_, t);
        return least(t);
    }

  private:
    /// By reference: vectors as results mean different things with and without AVX.
    void set_t_of(const Vec4d& face, Vec4d& t) const {
        t = parallel_ ? Vec4d{} + std::numeric_limits<double>::infinity() : (face - offset_) * inverse_;
    }
    static double least(const Vec4d& v) {
        const double xy = v[0] < v[1] ? v[0] : v[1];
        return xy < v[2] ? xy : v[2];
    }

    Vec4d offset_, direction_, inverse_;  ///< of the ray, in cells
    Vec4d up_, step_, last_cell_;         ///< 1 or 0; 1 or -1
    Vec4d border_, next_, after_;         ///< the face ahead; its t; the t of the one behind it
    Vec4l parallel_, stride_, signed_stride_;
    std::int64_t index_ = 0;
    double crossing_ = 0.0, end_ = 0.0;
};

}  // namespace mote::media::detail
