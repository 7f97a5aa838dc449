#include "gathering/micro_buffers/warped_walk.h"

#include <algorithm>

#include "gathering/micro_buffers/node_rules.h"

namespace mote::gathering {

using namespace core;

namespace {

/// A box of the warped square, in rays.
struct WarpedImage {
    Vec2 lower, upper;
    float area() const { return (upper.x - lower.x) * (upper.y - lower.y); }
    bool empty() const { return !(upper.x > lower.x) || !(upper.y > lower.y); }
};

WarpedImage image_of(const BrdfWarp& warp, const Vec3& center, float radius, float side) {
    const float d = glm::length(center);
    Vec2 lower(0.0f), upper(1.0f);
    if (radius < 0.5f * d) {
        const Vec2 at = hemisphere_to_square(Vec3(center.x, center.y, std::max(center.z, 0.0f)) / d);
        const float reach = square_reach * radius / d + 1e-5f;
        lower = glm::max(at - reach, Vec2(0.0f)), upper = glm::min(at + reach, Vec2(1.0f));
    }
    WarpedImage image;
    warp.warp_box(lower, upper, image.lower, image.upper);
    image.lower *= side, image.upper *= side;
    return image;
}

}  // namespace

void walk_warped(const PointHierarchy& hierarchy, const MicroBufferSettings& settings, const BrdfWarp& warp,
                 const RayDirections& rays, const MicroReceiver& receiver, DepthRows out) {
    if (hierarchy.empty()) return;
    const float side = float(rays.side);
    // As large as the box around a disc of the cut's fraction of a texel.
    const float largest = settings.cut * sqr(2.0f * square_reach);
    for (NodePlace place = hierarchy.root(); hierarchy.exists(place);) {
        const std::uint32_t index = hierarchy.node_index(place);
        const PointNode& node = hierarchy.nodes()[index];
        const Vec3 center = fused_local(receiver.frame, node.center - receiver.position);
        const bool leaf = place.level == 0;
        const NodePlace after = place.skip();
        if (center.z + node.radius <= 0.0f) {  // below the receiver's horizon
            place = after;
            continue;
        }
        const WarpedImage image = image_of(warp, center, node.radius, side);
        const bool near = sqr(2.0f * node.radius) >= glm::dot(center, center);
        const bool small = leaf || (node.cone_cos >= flat_cosine && !near && image.area() <= largest);
        if (!image.empty() && !small) {
            place = place.first_child();
            continue;
        }
        if (!image.empty()) {
            const LocalDisc disc{center, fused_local(receiver.frame, node.axis), node.radius,
                                 near_back * node.radius, index};
            // The rays at i + place, as in group_walk.cpp.
            const Vec2 to_next = Vec2(1.0f) - settings.place;
            const glm::ivec2 first(glm::max(image.lower - 0.01f + to_next, Vec2(0.0f))),
                last(glm::min(image.upper + 0.01f + to_next, Vec2(side)));
            fill_box(rays, disc, {first.x, first.y, last.x, last.y}, out);
        }
        place = after;
    }
}

}  // namespace mote::gathering
