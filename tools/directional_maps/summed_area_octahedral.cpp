#include "tools/directional_maps/summed_area_octahedral.h"

#include <fmt/format.h>

#include "core/objects/error.h"

namespace mote::tools {

using namespace core;
using namespace lights;

namespace {

/// At the centre of a texel, per area of the square [-1, 1]^2: the inverse cube of the distance to the face.
double solid_angle_density(int i, int j, int size) {
    const double x = std::fabs((2.0 * i + 1.0) / size - 1.0), y = std::fabs((2.0 * j + 1.0) / size - 1.0);
    const double z = 1.0 - x - y;
    const Vec3d p = z >= 0.0 ? Vec3d(x, y, z) : Vec3d(1.0 - y, 1.0 - x, z);
    return 1.0 / (glm::dot(p, p) * glm::length(p));
}

}  // namespace

SummedAreaOctahedral::SummedAreaOctahedral(OctahedralMap map, std::span<const Rgb> texels) : map_(map) {
    const int n = map.size, stride = n + 1;
    if (n < 1 || texels.size() != std::size_t(n) * std::size_t(n))
        throw InputError(fmt::format("{} texels for an octahedral map of size {}", texels.size(), n));
    table_.assign(std::size_t(stride) * std::size_t(stride), glm::dvec4(0.0));
    const double area = 4.0 / (double(n) * n);
    for (int j = 0; j < n; ++j) {
        glm::dvec4 row(0.0);
        for (int i = 0; i < n; ++i) {
            const double weight = area * solid_angle_density(i, j, n);
            row += weight * glm::dvec4(Vec3d(texels[std::size_t(j * n + i)]), 1.0);
            table_[std::size_t((j + 1) * stride + i + 1)] = table_[std::size_t(j * stride + i + 1)] + row;
        }
    }
}

SummedAreaOctahedral::Mean SummedAreaOctahedral::mean(const Vec3& d, float reach) const {
    const double r = std::clamp(double(reach), 1e-2, 0.5 * map_.size);
    const glm::dvec2 at = double(map_.size) * glm::dvec2(map_.uv(d));
    const glm::dvec4 sum = folded({at.x - r, at.y - r, at.x + r, at.y + r});
    return {Rgb(Vec3d(sum) / sum.w), float(sum.w)};
}

glm::dvec4 SummedAreaOctahedral::folded(Box b) const {
    const double n = map_.size;
    glm::dvec4 sum(0.0);
    // Beyond an edge, the square turned by half a circle about the edge's middle follows.
    if (b.x0 < 0.0) sum += folded({-std::min(b.x1, 0.0), n - b.y1, -b.x0, n - b.y0});
    if (b.x1 > n) sum += folded({2.0 * n - b.x1, n - b.y1, 2.0 * n - std::max(b.x0, n), n - b.y0});
    b.x0 = std::max(b.x0, 0.0), b.x1 = std::min(b.x1, n);
    if (b.x1 <= b.x0) return sum;
    if (b.y0 < 0.0) sum += folded({n - b.x1, -std::min(b.y1, 0.0), n - b.x0, -b.y0});
    if (b.y1 > n) sum += folded({n - b.x1, 2.0 * n - b.y1, n - b.x0, 2.0 * n - std::max(b.y0, n)});
    b.y0 = std::max(b.y0, 0.0), b.y1 = std::min(b.y1, n);
    if (b.y1 <= b.y0) return sum;
    return sum + inside(b);
}

glm::dvec4 SummedAreaOctahedral::inside(const Box& b) const {
    return corner(b.x1, b.y1) - corner(b.x0, b.y1) - corner(b.x1, b.y0) + corner(b.x0, b.y0);
}

glm::dvec4 SummedAreaOctahedral::corner(double x, double y) const {
    // NaN leads to the first texel, but stays in the fractions.
    const double last = map_.size - 1;
    const int i = int(std::max(0.0, std::min(x, last))), j = int(std::max(0.0, std::min(y, last)));
    const double s = x - i, t = y - j;
    const glm::dvec4* low = &table_[std::size_t(j) * std::size_t(map_.size + 1) + std::size_t(i)];
    const glm::dvec4* high = low + map_.size + 1;
    return (1.0 - t) * ((1.0 - s) * low[0] + s * low[1]) + t * ((1.0 - s) * high[0] + s * high[1]);
}

}  // namespace mote::tools
