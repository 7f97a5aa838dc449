#include "gathering/micro_buffers/hemisphere_texels.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/math/warp.h"
#include "core/objects/error.h"

namespace mote::gathering {

using namespace core;

namespace {

Vec2 disk_to_square(const Vec2& d) {
    const float x = std::fabs(d.x), y = std::fabs(d.y), r = glm::length(d);
    if (r == 0.0f) return {0.5f, 0.5f};
    const float along = x >= y ? std::copysign(r, d.x) : std::copysign(r, d.y);
    const float angle = std::atan(std::min(x, y) / std::max(x, y)) * (4.0f * inv_pi);
    const float across = std::copysign(r * angle, x >= y ? d.y : d.x);
    const Vec2 square = x >= y ? Vec2(along, across) : Vec2(across, along);
    return 0.5f * square + Vec2(0.5f);
}

}  // namespace

Vec3 square_to_hemisphere(HemisphereMap map, const Vec2& square) {
    const Vec2 d = square_to_disk(square);
    const float r2 = std::min(glm::dot(d, d), 1.0f);
    if (map == HemisphereMap::cosine) return {d.x, d.y, std::sqrt(1.0f - r2)};
    const float scale = std::sqrt(2.0f - r2);  // z = 1 - r^2, sin^2 = r^2 (2 - r^2)
    return {d.x * scale, d.y * scale, 1.0f - r2};
}

Vec2 hemisphere_to_square(HemisphereMap map, const Vec3& w) {
    const float scale = map == HemisphereMap::cosine ? 1.0f : 1.0f / std::sqrt(1.0f + std::max(w.z, 0.0f));
    return disk_to_square({w.x * scale, w.y * scale});
}

HemisphereTexels::HemisphereTexels(HemisphereMap map, std::uint32_t side, const Vec2& place)
    : map_(map), side_(side) {
    if (side == 0 || side > 256)
        throw InputError(fmt::format("micro-buffers have 1 to 256 texels a side, not {}", side));
    // Both maps keep areas of one kind; the other kind by Simpson-like midpoints within the texel.
    constexpr std::uint32_t cuts = 16;
    const double share = 1.0 / double(side * side);
    double sum = 0.0;
    std::vector<double> means(count());
    for (std::uint32_t texel = 0; texel < count(); ++texel) {
        const std::uint32_t i = texel % side, j = texel / side;
        const auto at = [&](double x, double y) {
            return square_to_hemisphere(map,
                                        Vec2(float((i + x) / double(side)), float((j + y) / double(side))));
        };
        directions_.push_back(at(double(place.x), double(place.y)));
        for (std::uint32_t k = 0; k < cuts * cuts; ++k) {
            const double z = double(at((k % cuts + 0.5) / cuts, (k / cuts + 0.5) / cuts).z);
            means[texel] += map == HemisphereMap::cosine ? 1.0 / std::max(z, 1e-6) : z;
        }
        sum += means[texel];
    }
    for (const double mean : means) {
        const bool cosine = map == HemisphereMap::cosine;
        cosine_weights_.push_back(float(double(pi) * (cosine ? share : mean / sum)));
        solid_angles_.push_back(float(2.0 * double(pi) * (cosine ? mean / sum : share)));
    }
}

}  // namespace mote::gathering
