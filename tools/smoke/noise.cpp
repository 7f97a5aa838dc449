#include "tools/smoke/noise.h"

#include "core/math/random.h"

namespace mote::tools {

using core::Vec3;

namespace {

// Quintic fade, continuous in its second derivative (Perlin 2002).
float fade(float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }

}  // namespace

float Noise::gradient(int x, int y, int z, const Vec3& offset) const {
    const std::uint64_t h = core::hash_keys(seed_, std::uint32_t(x), std::uint32_t(y), std::uint32_t(z));
    // The twelve edge midpoints of a cube: two components are +-1, one is 0.
    const float a = (h & 1u) ? 1.0f : -1.0f;
    const float b = (h & 2u) ? 1.0f : -1.0f;
    switch ((h >> 8) % 3u) {
        case 0:
            return a * offset.x + b * offset.y;
        case 1:
            return a * offset.y + b * offset.z;
        default:
            return a * offset.z + b * offset.x;
    }
}

float Noise::at(const Vec3& p) const {
    const Vec3 base = glm::floor(p);
    const Vec3 f = p - base;
    const int x = int(base.x), y = int(base.y), z = int(base.z);
    const Vec3 w(fade(f.x), fade(f.y), fade(f.z));
    float corner[2][2][2];
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                corner[k][j][i] = gradient(x + i, y + j, z + k, f - Vec3(float(i), float(j), float(k)));
    float plane[2];
    for (int k = 0; k < 2; ++k)
        plane[k] = core::lerp(core::lerp(corner[k][0][0], corner[k][0][1], w.x),
                              core::lerp(corner[k][1][0], corner[k][1][1], w.x), w.y);
    return core::lerp(plane[0], plane[1], w.z);
}

float Noise::fractal(const Vec3& p, int octaves, float gain) const {
    float sum = 0.0f, height = 1.0f, total = 0.0f, frequency = 1.0f;
    for (int i = 0; i < octaves; ++i) {
        // The offset keeps the lattices of the octaves from lining up at the origin.
        sum += height * at(p * frequency + Vec3(17.3f, 5.7f, 11.9f) * float(i));
        total += height, height *= gain, frequency *= 2.0f;
    }
    return total > 0.0f ? sum / total : 0.0f;
}

float Noise::billow(const Vec3& p, int octaves, float gain) const {
    float sum = 0.0f, height = 1.0f, total = 0.0f, frequency = 1.0f;
    for (int i = 0; i < octaves; ++i) {
        sum += height * std::fabs(at(p * frequency + Vec3(3.1f, 13.7f, 7.9f) * float(i)));
        total += height, height *= gain, frequency *= 2.0f;
    }
    return total > 0.0f ? sum / total : 0.0f;
}

Vec3 Noise::vector_at(const Vec3& p) const {
    return {at(p), at(p + Vec3(31.4f, 0.0f, 0.0f)), at(p + Vec3(0.0f, 47.2f, 0.0f))};
}

}  // namespace mote::tools
