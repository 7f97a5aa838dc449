#include "gathering/micro_buffers/micro_buffers.h"

#include <algorithm>

#include "core/objects/error.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Discs are met within this of where the ray starts from behind only, in their radius: a receiver on a
/// convex surface lies below the discs of its neighbours.
constexpr float near_back = 1.0f;
/// A node is a disc where its normals lie within this cosine of their mean; others are entered.
constexpr float flat = 0.8f;

/// Scalar and plain: one receiver's walk.
class BufferWalk {
  public:
    BufferWalk(const PointHierarchy& hierarchy, const MicroBufferSettings& settings,
               const HemisphereTexels& texels, const MicroReceiver& receiver, std::span<MicroTexel> out)
        : hierarchy_(hierarchy), settings_(settings), texels_(texels), receiver_(receiver), out_(out) {}

    void run() {
        const float side = float(texels_.side());
        for (NodePlace place = hierarchy_.root(); hierarchy_.exists(place);) {
            const std::uint32_t index = hierarchy_.node_index(place);
            const PointNode& node = hierarchy_.nodes()[index];
            const Vec3 center = receiver_.frame.to_local(node.center - receiver_.position);
            const float d2 = glm::dot(center, center), r2 = sqr(node.radius);
            if (center.z + node.radius <= 0.0f) {
                place = place.skip();
                continue;
            }
            // pi r^2 / d^2 against pi / (n^2 cos) or 2 pi / n^2.
            const float texel = settings_.map == HemisphereMap::cosine
                                    ? std::sqrt(d2) / std::max(center.z + node.radius, 1e-20f)
                                    : 2.0f;
            const bool small =
                r2 * sqr(side) <= settings_.cut * texel * d2 && r2 < d2 && node.cone_cos >= flat;
            if (!small && place.level > 0) {
                place = place.first_child();
                continue;
            }
            fill(index, node, center, d2, place.level == 0 && !settings_.cast_leaves);
            place = place.skip();
        }
    }

  private:
    void fill(std::uint32_t index, const PointNode& node, const Vec3& center, float d2, bool one_texel) {
        const float d = std::sqrt(d2), side = float(texels_.side());
        const Vec3 axis = receiver_.frame.to_local(node.axis);
        std::uint32_t from[2] = {0, 0}, to[2] = {texels_.side(), texels_.side()};
        if (node.radius < 0.5f * d || one_texel) {
            const Vec2 at = side * hemisphere_to_square(
                                       settings_.map, Vec3(center.x, center.y, std::max(center.z, 0.0f)) / d);
            const float reach = one_texel ? 0.0f : 0.9f * side * node.radius / d;
            for (int k = 0; k < 2; ++k) {
                from[k] = std::uint32_t(std::clamp(std::ceil(at[k] - reach - 0.5f), 0.0f, side));
                to[k] = std::uint32_t(std::clamp(std::floor(at[k] + reach + 0.5f), 0.0f, side));
            }
        }
        for (std::uint32_t j = from[1]; j < to[1]; ++j)
            for (std::uint32_t i = from[0]; i < to[0]; ++i)
                test(j * texels_.side() + i, index, node, center, axis);
    }
    void test(std::uint32_t texel, std::uint32_t index, const PointNode& node, const Vec3& center,
              const Vec3& axis) {
        const Vec3& w = texels_.directions()[texel];
        const float facing = glm::dot(axis, w), t = glm::dot(axis, center) / facing;
        const Vec3 off = t * w - center;
        if (!(t > 0.0f) || !(glm::dot(off, off) <= sqr(node.radius))) return;
        if (facing > 0.0f && t < near_back * node.radius) return;
        MicroTexel& nearest = out_[texel];
        if (t < nearest.distance) nearest = {t, index | (facing > 0.0f ? MicroTexel::back_bit : 0u)};
    }

    const PointHierarchy& hierarchy_;
    const MicroBufferSettings& settings_;
    const HemisphereTexels& texels_;
    const MicroReceiver& receiver_;
    std::span<MicroTexel> out_;
};

}  // namespace

MicroBuffers::MicroBuffers(const PointHierarchy& hierarchy, const MicroBufferSettings& settings)
    : hierarchy_(hierarchy), settings_(settings), texels_(settings.map, settings.side) {
    if (!(settings.cut > 0.0f)) throw InputError("the cut of micro-buffers must be positive");
}

void MicroBuffers::render(std::span<const MicroReceiver> receivers, std::span<MicroTexel> texels) const {
    std::fill(texels.begin(), texels.end(), MicroTexel{});
    if (hierarchy_.empty()) return;
    for (std::size_t i = 0; i < receivers.size(); ++i)
        BufferWalk(hierarchy_, settings_, texels_, receivers[i],
                   texels.subspan(i * texels_each(), texels_each()))
            .run();
}

Rgb gathered(std::span<const MicroTexel> texels, std::span<const float> weights, const NodeRadiance& radiance,
             const Rgb& environment) {
    Vec3d sum(0.0);
    for (std::size_t i = 0; i < texels.size(); ++i)
        sum +=
            double(weights[i]) *
            Vec3d(texels[i].empty() ? environment : radiance.of(texels[i].node(), texels[i].from_behind()));
    return Rgb(sum);
}

void gather_irradiance(const MicroBuffers& buffers, const NodeRadiance& radiance,
                       std::span<const MicroReceiver> receivers, std::span<Rgb> irradiance,
                       const Rgb& environment) {
    buffers.for_each(receivers, [&](std::size_t i, std::span<const MicroTexel> texels) {
        irradiance[i] = gathered(texels, buffers.texels().cosine_weights(), radiance, environment);
    });
}

}  // namespace mote::gathering
