#include "gathering/volume_points/fog_walk.h"

#include <algorithm>

#include "core/math/vectorize.h"
#include "gathering/micro_buffers/arc_tangent.h"
#include "gathering/micro_buffers/node_rules.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Points with a radius below this many texels, across, fall on one texel.
constexpr float point_like = 0.5f;

/// hemisphere_to_square(), within some 1e-5, without branches.
inline Vec2 square_of(const Vec3& w, bool cosine) {
    const float up = max_of(w.z, 0.0f), flat = std::sqrt(w.x * w.x + w.y * w.y);
    const float radius = min_of(cosine ? flat : flat / std::sqrt(1.0f + up), 1.0f);
    const float ax = std::fabs(w.x), ay = std::fabs(w.y), longer = max_of(max_of(ax, ay), 1e-30f);
    const float across = radius * (4.0f * inv_pi) * arc_tangent(min_of(ax, ay) / longer);
    return {0.5f + 0.5f * std::copysign(ax < ay ? across : radius, w.x),
            0.5f + 0.5f * std::copysign(ax < ay ? radius : across, w.y)};
}

class Walk {
  public:
    Walk(const FogWalk& walk, const MicroReceiver& receiver, FogScratch& scratch)
        : w_(walk), receiver_(receiver), scratch_(scratch), side_(float(walk.rays.side)) {
        const bool cosine = w_.map == HemisphereMap::cosine;
        // Of a texel: solid angle, or projected solid angle.
        texel_ = (cosine ? pi : 2.0f * pi) / (side_ * side_);
    }

    void run() {
        const PointHierarchy& tree = w_.hierarchy.tree();
        if (tree.empty()) return;
        for (NodePlace place = tree.root(); tree.exists(place);) {
            const std::uint32_t index = tree.node_index(place);
            const PointNode& node = tree.nodes()[index];
            const bool leaf = place.level == 0;
            const float radius = leaf ? w_.hierarchy.radius(index) : node.radius;
            const Vec3 off = node.center - receiver_.position;
            const float up = glm::dot(off, receiver_.frame.n), d2 = glm::dot(off, off), r2 = radius * radius;
            const bool below = up + radius <= 0.0f;
            const bool small = pi * r2 <= w_.cut * texel_ * d2 && 4.0f * r2 < d2;
            if (!below && !leaf && !small) {
                place = place.first_child();
                continue;
            }
            if (!below) add(index, off, up, d2, radius, leaf);
            place = place.skip();
        }
    }

  private:
    void add(std::uint32_t index, const Vec3& off, float up, float d2, float radius, bool leaf) {
        const float d = std::sqrt(d2);
        // A receiver in the middle of a ball: any direction is the way to it.
        const Vec3 away = d > 1e-6f * radius ? off / d : receiver_.frame.n;
        const Vec3 local(glm::dot(away, receiver_.frame.s), glm::dot(away, receiver_.frame.t),
                         glm::dot(away, receiver_.frame.n));
        const Vec2 at = square_of(local, w_.map == HemisphereMap::cosine) * side_;
        const glm::uvec2 texel(glm::clamp(at, Vec2(0.0f), Vec2(side_ - 1.0f)));
        const Rgb light =
            w_.light.intensity(index, -away) * scratch_.depths->transmittance(texel.x, texel.y, d);
        if (leaf && pi * radius * radius > sqr(point_like) * texel_ * d2)
            return add_ball(light, d * local, radius, at);
        if (up > 0.0f) add_point(light, texel, local.z, d, radius);
    }

    /// To one texel; as much of it as is not behind the surface there.
    void add_point(const Rgb& light, const glm::uvec2& texel, float cosine, float d, float radius) {
        const std::size_t i = std::size_t(texel.y) * w_.rays.side + texel.x;
        const float seen =
            std::clamp(0.5f + 0.5f * (scratch_.distance[i] - d) / std::max(radius, 1e-30f), 0.0f, 1.0f);
        const float share = w_.map == HemisphereMap::cosine ? cosine : 1.0f;
        const Rgb radiance = light * (seen * share / (d * d * texel_));
        scratch_.red[i] += radiance.x, scratch_.green[i] += radiance.y, scratch_.blue[i] += radiance.z;
    }

    /// Evenly filled: every ray gathers along its way through it, as far as the surface.
    void add_ball(const Rgb& light, const Vec3& center, float radius, const Vec2& at) {
        const Rgb density = light * (3.0f / (4.0f * pi * radius * radius * radius));
        const float d = glm::length(center), angle = radius / std::max(d, 1e-30f);
        const float reach = angle < 0.5f ? 1.2f * square_reach * side_ * angle + 1.0f : side_;
        const glm::ivec2 first(glm::max(at - reach, Vec2(0.0f))),
            last(glm::min(glm::ceil(at + reach), Vec2(side_)));
        const float beside = glm::dot(center, center) - radius * radius;
        constexpr auto lanes = std::int32_t(RayDirections::lanes);
        for (std::int32_t y = first.y; y < last.y; ++y)
            for (std::int32_t x = first.x; x < last.x; x += lanes) {
                const std::size_t i = std::size_t(y) * w_.rays.side + std::size_t(x);
                const float *wx = w_.rays.x.data() + i, *wy = w_.rays.y.data() + i,
                            *wz = w_.rays.z.data() + i, *surface = scratch_.distance.data() + i;
                float *red = scratch_.red.data() + i, *green = scratch_.green.data() + i,
                      *blue = scratch_.blue.data() + i;
                // Lanes beyond the box belong to others.
                const std::int32_t used = std::min(lanes, last.x - x);
                MOTE_INDEPENDENT_LANES
                for (std::int32_t k = 0; k < lanes; ++k) {
                    const float along = wx[k] * center.x + wy[k] * center.y + wz[k] * center.z;
                    const float half2 = along * along - beside, half = std::sqrt(max_of(half2, 0.0f));
                    const float way = min_of(along + half, surface[k]) - max_of(along - half, 0.0f);
                    const float chord = ((half2 > 0.0f) & (k < used)) ? max_of(way, 0.0f) : 0.0f;
                    red[k] += chord * density.x, green[k] += chord * density.y, blue[k] += chord * density.z;
                }
            }
    }

    const FogWalk& w_;
    const MicroReceiver& receiver_;
    FogScratch& scratch_;
    float side_, texel_;
};

}  // namespace

void walk_fog(const FogWalk& walk, const MicroReceiver& receiver, FogScratch& scratch) {
    Walk(walk, receiver, scratch).run();
}

}  // namespace mote::gathering
