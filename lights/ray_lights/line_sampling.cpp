#include "lights/ray_lights/line_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mote::lights {

using namespace core;

namespace {

/// Below this sine lines are parallel: what rounding of single precision leaves of an angle.
constexpr double parallel = 1e-7;
/// Below this, sinh(x) / x and its inverse are 1 to double precision.
constexpr double tiny = 1e-8;

double squared(double x) { return x * x; }  // core::sqr() is for single precision

}  // namespace

LinePair line_pair(const Vec3d& first_origin, const Vec3d& first_direction, const Vec3d& second_origin,
                   const Vec3d& second_direction) {
    const Vec3d between = second_origin - first_origin,
                normal = glm::cross(first_direction, second_direction);
    const double sine_squared = glm::dot(normal, normal);
    LinePair pair;
    if (sine_squared < parallel * parallel) {
        pair.nearest_first = glm::dot(between, first_direction);
        pair.distance = glm::length(between - pair.nearest_first * first_direction);
        return pair;
    }
    pair.sine = std::sqrt(sine_squared);
    pair.nearest_first = glm::dot(glm::cross(between, second_direction), normal) / sine_squared;
    pair.nearest_second = glm::dot(glm::cross(between, first_direction), normal) / sine_squared;
    pair.distance = std::fabs(glm::dot(between, normal)) / pair.sine;
    return pair;
}

double InverseDistance::density(double u) const {
    return 1.0 / std::sqrt(distance * distance + squared(sine * (u - nearest)));
}
double InverseDistance::integral(double u) const {
    const double x = (u - nearest) / distance;
    return std::fabs(sine * x) < tiny ? x : std::asinh(sine * x) / sine;
}
double InverseDistance::inverse(double integral) const {
    const double x = sine * integral;
    return nearest + distance * (std::fabs(x) < tiny ? integral : std::sinh(x) / sine);
}

double InverseSquare::density(double v) const { return 1.0 / (squared(distance) + squared(v - nearest)); }
double InverseSquare::integral(double v) const { return std::atan((v - nearest) / distance) / distance; }
double InverseSquare::inverse(double integral) const {
    return nearest + distance * std::tan(distance * integral);
}

template <typename Density>
std::optional<LineSample> sample_line(const Density& density, double begin, double end, double length,
                                      std::span<const float> weights, float u) {
    if (!(begin < end)) return std::nullopt;
    const std::size_t cells = weights.size();
    std::array<double, max_cells + 1> edges, integrals;
    std::array<double, max_cells> masses;
    double sum = 0.0;
    for (std::size_t i = 0; i <= cells; ++i) {
        edges[i] = std::clamp(length * double(i) / double(cells), begin, end);
        integrals[i] = density.integral(edges[i]);
        if (i > 0) sum += masses[i - 1] = double(weights[i - 1]) * (integrals[i] - integrals[i - 1]);
    }
    if (!(sum > 0.0) || !std::isfinite(sum)) return std::nullopt;
    double rest = double(u) * sum;
    std::size_t cell = 0;
    while (cell + 1 < cells && rest >= masses[cell]) rest -= masses[cell++];
    while (cell > 0 && !(masses[cell] > 0.0)) --cell, rest = masses[cell];  // rounding led beyond the last
    if (!(masses[cell] > 0.0)) return std::nullopt;
    const double fraction = std::min(rest / masses[cell], 1.0);
    const double position =
        std::clamp(density.inverse(integrals[cell] + fraction * (integrals[cell + 1] - integrals[cell])),
                   edges[cell], edges[cell + 1]);
    const double pdf = double(weights[cell]) * density.density(position) / sum;
    if (!(pdf > 0.0) || !std::isfinite(pdf)) return std::nullopt;
    return LineSample{position, pdf};
}

template std::optional<LineSample> sample_line(const InverseDistance&, double, double, double,
                                               std::span<const float>, float);
template std::optional<LineSample> sample_line(const InverseSquare&, double, double, double,
                                               std::span<const float>, float);

}  // namespace mote::lights
