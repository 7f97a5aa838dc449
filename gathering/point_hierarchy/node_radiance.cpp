#include "gathering/point_hierarchy/node_radiance.h"

#include <fmt/format.h>

#include "core/objects/error.h"

namespace mote::gathering {

using namespace core;

namespace {

void check(const PointHierarchy& hierarchy, std::span<const Rgb> side) {
    if (side.size() != hierarchy.points())
        throw InputError(
            fmt::format("radiance of {} points for a hierarchy of {}", side.size(), hierarchy.points()));
    for (const Rgb& value : side)
        if (!is_finite(value)) throw InputError("the radiance of points must be finite");
}

}  // namespace

NodeRadiance::NodeRadiance(const PointHierarchy& hierarchy, std::span<const Rgb> front,
                           std::span<const Rgb> back) {
    check(hierarchy, front);
    if (!back.empty()) check(hierarchy, back);
    front_ = pulled_up(hierarchy, front);
    if (!back.empty()) back_ = pulled_up(hierarchy, back);
}

}  // namespace mote::gathering
