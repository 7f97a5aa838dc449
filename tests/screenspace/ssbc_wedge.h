// Two half planes that meet at a right angle, lit evenly: exact compensation by quadrature, without the
// library.
//
// Along the edge nothing changes, so light is a function of the distance x to the edge, the same on both
// planes. With s = x^2 + z^2 the residual over a line parallel to the edge, at distance z on the other plane,
// is
//   K(x, z) = int max(x z / (s + y^2)^2 - b, 0) dy
//           = x z (Y / (s (s + Y^2)) + atan(Y / sqrt(s)) / s^(3/2)) - 2 b Y,      Y^2 = sqrt(x z / b) - s
// and 0 where Y^2 < 0. One step is (T_r L)(x) = rho / pi int K(x, z) L(z) dz.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace mote::tests {

/// A function of the distance from the edge, by linear interpolation on points that crowd at the edge.
class WedgeLight {
  public:
    WedgeLight(double reach, double value) : reach_(reach), values_(points + 1, value) {}
    double position(int i) const { return reach_ * std::pow(double(i) / points, 3.0); }
    double operator()(double x) const {
        if (x >= reach_) return values_[points];
        const double t = points * std::cbrt(x / reach_);
        const int i = std::min(int(t), points - 1);
        const double w = (x - position(i)) / (position(i + 1) - position(i));
        return (1.0 - w) * values_[std::size_t(i)] + w * values_[std::size_t(i) + 1];
    }
    /// T_r of it.
    WedgeLight step(double bound, double reflectance) const {
        WedgeLight result(reach_, 0.0);
        for (int i = 1; i <= points; ++i)
            result.values_[std::size_t(i)] = reflectance / std::acos(-1.0) * integral(position(i), bound);
        result.values_[0] = result.values_[1];
        return result;
    }

    WedgeLight operator+(const WedgeLight& other) const {
        WedgeLight sum = *this;
        for (std::size_t i = 0; i < values_.size(); ++i) sum.values_[i] += other.values_[i];
        return sum;
    }

  private:
    static constexpr int points = 200;

    static double kernel(double x, double z, double b) {
        const double s = x * x + z * z, y2 = std::sqrt(x * z / b) - s;
        if (!(y2 > 0.0)) return 0.0;
        const double y = std::sqrt(y2), root = std::sqrt(s);
        return x * z * (y / (s * (s + y2)) + std::atan(y / root) / (s * root)) - 2.0 * b * y;
    }
    /// Over z = x tan(phi), which spreads the peak near z = x evenly.
    double integral(double x, double b) const {
        const int n = 2000;
        const double step = 0.5 * std::acos(-1.0) / n;
        double sum = 0.0;
        for (int i = 0; i < n; ++i) {
            const double phi = (i + 0.5) * step, z = x * std::tan(phi), c = std::cos(phi);
            if (const double k = kernel(x, z, b); k > 0.0) sum += k * (*this)(z)*x / (c * c);
        }
        return sum * step;
    }

    double reach_;
    std::vector<double> values_;
};

}  // namespace mote::tests
