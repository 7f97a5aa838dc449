#include "tools/geometry/cloth.h"

namespace mote::tools {

using core::lerp;
using core::pi;

void add_curtain(Soup& soup, const Hanging& c, core::Rng& rng, float detail) {
    const Vec3 along = c.b - c.a, across = glm::normalize(Vec3(-along.z, 0.0f, along.x));
    const float shift = 6.0f * rng.next_float(), pleats = float(c.pleats);
    soup.sheet(segments(5.0f * pleats, detail, c.pleats), segments(16, detail), [&](float u, float v) {
        const float down = 1.0f - v, tie = std::exp(-core::sqr((down - 0.66f) / 0.13f));
        const float s = 0.5f + (u - 0.5f) * (1.0f - 0.45f * tie);
        const float wave = std::sin(2.0f * pi * pleats * u + 1.1f * std::sin(3.0f * u + shift) + 0.9f * down);
        const float deep = lerp(0.03f, 0.09f, down) * (1.0f - 0.4f * tie);
        const float uneven = 0.03f * down * std::sin(9.0f * u + shift);
        return c.a + s * along + (deep * wave + uneven) * across -
               Vec3(0.0f, c.drop * down * (1.0f + 0.015f * wave), 0.0f);
    });
}

void add_banner(Soup& soup, const Hanging& c, core::Rng& rng, float detail) {
    const Vec3 along = c.b - c.a, across = glm::normalize(Vec3(-along.z, 0.0f, along.x));
    const float shift = 6.0f * rng.next_float();
    soup.sheet(segments(14, detail, 4), segments(30, detail, 4), [&](float u, float v) {
        const float down = 1.0f - v, tip = 1.0f - 0.5f * std::fabs(u - 0.5f);
        const float wave = 0.07f * down * std::sin(5.0f * down + 2.4f * u + shift) +
                           0.025f * std::sin(13.0f * u + shift + 2.0f * down);
        return c.a + u * along + wave * across - Vec3(0.0f, c.drop * down * lerp(1.0f, tip, down), 0.0f);
    });
}

void add_sail(Soup& soup, const Vec3& lower, const Vec3& upper, float sag, core::Rng& rng, float detail) {
    const float shift = 6.0f * rng.next_float();
    soup.sheet(segments(16, detail, 4), segments(44, detail, 6), [&](float u, float v) {
        // Seen from above; the edges are pulled in where the cloth sags most.
        const float hang = 4.0f * v * (1.0f - v), pull = 0.14f * hang;
        const float y = lower.y - sag * hang * (0.92f + 0.3f * core::sqr(u - 0.5f)) +
                        0.05f * hang * std::sin(9.0f * u + shift) +
                        0.03f * std::sin(14.0f * v + 4.0f * u + shift);
        return Vec3(lerp(lower.x, upper.x, 0.5f + (u - 0.5f) * (1.0f - pull)), y, lerp(upper.z, lower.z, v));
    });
}

}  // namespace mote::tools
