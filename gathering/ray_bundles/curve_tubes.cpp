#include "gathering/ray_bundles/curve_tubes.h"

#include <algorithm>
#include <numbers>

#include "core/geometry/instances.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t min_sides = 8, max_sides = 64, max_pieces = 1024;

/// The centre line with its radius as fourth component, and its direction.
struct LinePoint {
    glm::dvec4 at, along;
};

LinePoint line_point(const Curves& curves, std::uint32_t segment, double u) {
    const glm::vec4* p = &curves.data().points[curves.data().segments[segment]];
    const glm::dvec4 a(p[0]), b(p[1]);
    if (curves.data().basis == CurveBasis::linear) return {a + u * (b - a), b - a};
    const glm::dvec4 c(p[2]), d(p[3]);
    const double v = 1.0 - u, u2 = u * u, u3 = u2 * u;
    return {(v * v * v * a + (4.0 - 6.0 * u2 + 3.0 * u3) * b + (1.0 + 3.0 * u + 3.0 * u2 - 3.0 * u3) * c +
             u3 * d) /
                6.0,
            (-v * v * a + (3.0 * u2 - 4.0 * u) * b + (1.0 + 2.0 * u - 3.0 * u2) * c + u2 * d) / 2.0};
}

/// The largest second derivative: that of a cubic B-spline runs between its control points' differences.
double largest_bend(const Curves& curves, std::uint32_t segment) {
    if (curves.data().basis == CurveBasis::linear) return 0.0;
    const glm::vec4* p = &curves.data().points[curves.data().segments[segment]];
    const auto difference = [&](int i) { return double(glm::length(p[i] - 2.0f * p[i + 1] + p[i + 2])); };
    return std::max(difference(0), difference(1));
}

/// Corners around the line at u; the last lies on the first. Texture coordinates as those of Curves.
std::vector<TriangleList::Corner> ring(const Curves& curves, const Placement* place, std::uint32_t segment,
                                       double u, std::uint32_t sides) {
    const LinePoint line = line_point(curves, segment, u);
    const double length = glm::length(Vec3d(line.along));
    const Vec3d tangent = length > 0.0 ? Vec3d(line.along) / length : Vec3d(1, 0, 0);
    const Vec3d guide = Vec3d(0, 0, 1) - tangent * tangent.z;
    const Vec3d next = glm::length(guide) > 0.0 ? glm::normalize(guide) : Vec3d(0, 1, 0),
                start = glm::cross(next, tangent);
    std::vector<TriangleList::Corner> corners(sides + 1);
    for (std::uint32_t i = 0; i <= sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * double(i % sides) / double(sides);
        const Vec3d radial = std::cos(angle) * start + std::sin(angle) * next;
        const Vec3d position = Vec3d(line.at) + line.at.w * radial;
        corners[i].position = Vec3(place ? place->to_world().point(position) : position);
        corners[i].normal = Vec3(place ? place->world_normal(radial) : radial);
        corners[i].uv =
            Vec2(float(i) / float(sides), float((segment + u) / double(curves.data().segments.size())));
    }
    return corners;
}

}  // namespace

std::size_t TubeCuts::triangles() const {
    std::size_t pieces = 0;
    for (const std::uint32_t n : along) pieces += n;
    return 2 * pieces * around;
}

TubeCuts tube_cuts(const Curves& curves, float chord_error) {
    const double tolerance =
        0.5 * double(std::max(chord_error, 1e-6f)) * double(glm::length(curves.bounds().diagonal()));
    float widest = 0.0f;
    for (const glm::vec4& p : curves.data().points) widest = std::max(widest, p.w);
    // A chord over an angle of 2 a lies r (1 - cos a) within the circle.
    const double cos_half = std::max(1.0 - tolerance / double(widest), -1.0);
    TubeCuts cuts;
    cuts.around =
        std::clamp(std::uint32_t(std::ceil(std::numbers::pi / std::acos(cos_half))), min_sides, max_sides);
    for (std::uint32_t s = 0; s < curves.data().segments.size(); ++s) {
        const double pieces = std::ceil(std::sqrt(largest_bend(curves, s) / (8.0 * tolerance)));
        cuts.along.push_back(std::uint32_t(std::clamp(pieces, 1.0, double(max_pieces))));
    }
    return cuts;
}

void append_tubes(const Curves& curves, const Placement* place, const TubeCuts& cuts, TriangleList& list) {
    const bool mirrored = place && place->to_world().determinant() < 0.0;
    for (std::uint32_t s = 0; s < cuts.along.size(); ++s) {
        auto before = ring(curves, place, s, 0.0, cuts.around);
        for (std::uint32_t piece = 1; piece <= cuts.along[s]; ++piece) {
            auto after = ring(curves, place, s, double(piece) / cuts.along[s], cuts.around);
            const auto &front = mirrored ? after : before, &back = mirrored ? before : after;
            for (std::uint32_t i = 0; i < cuts.around; ++i) {
                list.add(front[i], front[i + 1], back[i], s);
                list.add(back[i], front[i + 1], back[i + 1], s);
            }
            before = std::move(after);
        }
    }
}

}  // namespace mote::gathering
