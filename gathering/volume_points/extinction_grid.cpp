#include "gathering/volume_points/extinction_grid.h"

#include <algorithm>

namespace mote::gathering {

using namespace core;

ExtinctionGrid::ExtinctionGrid(const Bounds3& box, const glm::ivec3& size, std::vector<Rgb> extinction)
    : box_(box), last_(size - 1), extinction_(std::move(extinction)) {
    per_metre_ = Vec3(size) / glm::max(box.diagonal(), Vec3(1e-30f));
    grey_ = std::all_of(extinction_.begin(), extinction_.end(),
                        [](const Rgb& c) { return c.x == c.y && c.x == c.z; });
}

}  // namespace mote::gathering
