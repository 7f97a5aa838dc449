// The kernel of one level of the a-trous transform for a few neighbouring pixels of a row.
//
// 5 x 5 taps of the B3 spline (1, 4, 6, 4, 1) / 16, `step` pixels apart, times the weights of same_surface.h.
// A weighted mean with them would pull a gradient towards the side that an edge leaves; the linear kernel is
// the value that a weighted linear regression over the taps has at the pixel itself:
//   w'_q = w_q (1 - (X_q - mu)^T M^-1 mu),   mu, M: mean and covariance of X under w, (3)
// X being the tap's place in the plane of the surface, or in the picture for volumes. So what is linear on a
// surface stays as it is, up to the edge.
#pragma once

#include <span>

#include "screenspace/layer_filter/filter_planes.h"

namespace mote::screenspace {

class LevelKernel {
  public:
    static constexpr int taps = 25, max_pixels = 64;

    /// For the pixels x0 ... x1 - 1 of row y, at most `max_pixels`.
    LevelKernel(const FilterPlanes& planes, int step, int y, int x0, int x1);

    /// Weighted mean with the taps' weights, all of which are positive.
    void average(std::span<const float> plane, float* out) const { apply(mean_, plane, out); }
    /// Value of the local linear regression. Call make_linear() first.
    void regress(std::span<const float> plane, float* out) const { apply(linear_, plane, out); }
    void make_linear();

  private:
    using Taps = float[taps][max_pixels];
    void weight_by_surface(int tap, float spline);
    void weight_by_volume(int tap, float spline);
    void place(int tap, Taps& x, Taps& y) const;
    void normalise();
    void apply(const Taps& weights, std::span<const float> plane, float* out) const;
    /// The part of the row whose tap lies in the picture.
    bool reach(int tap, int& first, int& last, std::ptrdiff_t& shift) const;

    const FilterPlanes& planes_;
    int step_, y_, x0_, count_;
    Taps mean_, linear_;
};

}  // namespace mote::screenspace
