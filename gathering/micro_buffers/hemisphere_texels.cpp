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

Vec3 square_to_hemisphere(const Vec2& square) {
    const Vec2 d = square_to_disk(square);
    return {d.x, d.y, std::sqrt(1.0f - std::min(glm::dot(d, d), 1.0f))};
}

Vec2 hemisphere_to_square(const Vec3& w) { return disk_to_square({w.x, w.y}); }

HemisphereTexels::HemisphereTexels(std::uint32_t side, const Vec2& place) : side_(side) {
    if (side == 0 || side > 256)
        throw InputError(fmt::format("micro-buffers have 1 to 256 texels a side, not {}", side));
    for (std::uint32_t texel = 0; texel < count(); ++texel)
        directions_.push_back(
            square_to_hemisphere(Vec2(float((texel % side + double(place.x)) / double(side)),
                                      float((texel / side + double(place.y)) / double(side)))));
}

}  // namespace mote::gathering
