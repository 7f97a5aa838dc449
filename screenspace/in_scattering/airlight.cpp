#include "screenspace/in_scattering/airlight.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace mote::screenspace {

using namespace core;

namespace {

// Gauss-Legendre rule of eight points on [-1, 1].
constexpr std::size_t points = 8;
constexpr std::array<double, points> node = {
    -0.96028985649753623168, -0.79666647741362673959, -0.52553240991632898582, -0.18343464249564980494,
    0.18343464249564980494,  0.52553240991632898582,  0.79666647741362673959,  0.96028985649753623168};
constexpr std::array<double, points> weight = {
    0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734, 0.36268378337836198297,
    0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915};

// The error on a panel of length 2l is below (64/15) M l rho^(-2n) / (1 - rho^-2), where |integrand| <= M
// within the ellipse of semi-axes l (rho +- 1/rho) / 2 around it (Trefethen 2008, Th. 4.5). The strip of
// half width pi/2 leaves rho = 4.4 for l = 0.75: 5e-11 M. The exponential over a panel along which its
// exponent falls by 2c has the error c^(2n) times 2^(2n+1) n!^4 / ((2n+1) (2n)!^3): 1e-10 of its largest
// value for c = 3.
constexpr double longest_panel = 1.5;
constexpr double exponent_of_panel = 6.0;
constexpr double longest_panel_of_profiles = 0.4;  ///< tested for the rims of spot lights
constexpr double negligible = 1e-9;                ///< fraction of the sum that may be left out

/// Henyey-Greenstein without its constants, for h = 1 - cos to the preferred direction, a = |g|.
double lobe(double a, double h) {
    const double q = (1.0 - a) * (1.0 - a) + 2.0 * a * h;
    return 1.0 / (q * std::sqrt(q));
}

/// A piece of a ray, in the variable delta = y - y(t0): d + s = sum e^delta, d - s = rest e^-delta.
struct Piece {
    double t0, sum, rest, span, start, h;

    Piece(const PassingRay& ray, double from, double to) : t0(from), h(ray.distance) {
        const double s0 = from - ray.nearest, s1 = to - ray.nearest, h2 = h * h;
        start = std::hypot(s0, h);
        const double end = std::hypot(s1, h), length = to - from;
        // of d + s and d - s one is a sum, and the other h^2 over it
        sum = s0 > 0.0 ? start + s0 : h2 / (start - s0);
        rest = s0 > 0.0 ? h2 / (start + s0) : start - s0;
        // tanh(span / 2) = length / (d0 + d1), and 1 minus that without a difference where it is near 1
        const double beyond = s1 > 0.0 ? h2 / (end + s1) : end - s1;  // d1 - s1
        const double fraction = length / (start + end);
        span =
            fraction < 0.5 ? 2.0 * std::atanh(fraction) : std::log((start + end + length) / (sum + beyond));
        if (!std::isfinite(to)) span = infinity;
    }
};

/// e^delta - 1 at the points of a panel, from its begin.
struct Growth {
    double length = 0.0;
    std::array<double, points> less_one{};
    void set_length(double l) {
        if (l == length) return;
        length = l;
        for (std::size_t i = 0; i < points; ++i) less_one[i] = std::expm1(0.5 * l * (1.0 + node[i]));
    }
};

template <typename Intensity>
double integrate(const PassingRay& ray, double t0, double t1, double sigma_t, double g, double longest,
                 const Intensity& intensity) {
    if (!(t0 < t1)) return 0.0;
    const Piece piece(ray, t0, t1);
    const double a = std::abs(g), reach = sigma_t * piece.sum;
    // A little longer than even panels, so that rounding makes no panel of its own.
    const double even =
        piece.span < infinity ? piece.span / std::ceil(piece.span / longest) * (1.0 + 1e-12) : longest;
    Growth growth;
    double total = 0.0;
    for (double begin = 0.0; begin < piece.span;) {
        const double grown_less_one = std::expm1(begin), grown = 1.0 + grown_less_one;
        growth.set_length(
            std::min({even, piece.span - begin, std::log1p(exponent_of_panel / (reach * grown))}));
        double panel = 0.0;
        for (std::size_t i = 0; i < points; ++i) {
            const double more = grown * (1.0 + growth.less_one[i]);
            const double ahead = piece.sum * more, back = piece.rest / more, d = 0.5 * (ahead + back);
            const double h = (g >= 0.0 ? ahead : back) / d;
            panel += weight[i] * std::exp(-reach * (grown_less_one + grown * growth.less_one[i])) *
                     lobe(a, h) / d * intensity(ray.nearest + 0.5 * (ahead - back));
        }
        total += 0.5 * growth.length * panel;
        begin += growth.length;
        // The rest is at most its largest exponential and lobe times the integral of dy/d.
        const double ahead = piece.sum * std::exp(begin), back = piece.rest * std::exp(-begin);
        const double d = 0.5 * (ahead + back), s = 0.5 * (ahead - back), left = piece.span - begin;
        const double of_distance =
            s > 0.0 ? std::min(left / d, 1.0 / s) : std::min(left, std::numbers::pi) / piece.h;
        const double of_lobe = lobe(a, s > 0.0 && g >= 0.0 ? 1.0 + s / d : 0.0);
        if (std::exp(-reach * std::expm1(begin)) * of_distance * of_lobe <= negligible * total) break;
    }
    return total * std::exp(-sigma_t * piece.start) * (1.0 - a) * (1.0 + a) / (4.0 * std::numbers::pi);
}

}  // namespace

PassingRay::PassingRay(const Ray& ray, const Vec3& light) {
    const Vec3d to_light = Vec3d(light) - Vec3d(ray.origin), direction(ray.direction);
    nearest = glm::dot(to_light, direction);
    const double scale = std::max(glm::length(to_light), double(ray.t_min));
    distance = std::max(glm::length(to_light - nearest * direction), 1e-5 * scale + 1e-30);
}

double airlight(const PassingRay& ray, double t0, double t1, double sigma_t, double g) {
    return integrate(ray, t0, t1, sigma_t, g, longest_panel, [](double) { return 1.0; });
}

double airlight(const PassingRay& ray, double t0, double t1, double sigma_t, double g,
                const std::function<double(double)>& intensity) {
    return integrate(ray, t0, t1, sigma_t, g, longest_panel_of_profiles, intensity);
}

}  // namespace mote::screenspace
