// Gradient noise (Perlin 2002, "Improving noise", with its table) and the cloud that pbrt-v4 makes of it.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/formats/pbrt/pbrt_media.h"

namespace mote::core {
namespace {

constexpr std::uint8_t permutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,
    69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,
    94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136,
    171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161,
    1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196, 135, 130, 116, 188, 159, 86,
    164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126,
    255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,   129, 22,  39,  253,
    19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,  242, 193,
    238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

double gradient(int x, int y, int z, const Vec3d& d) {
    const auto p = [](int i) { return int(permutation[i & 255]); };
    const int h = p(p(p(x) + y) + z) & 15;
    const double u = h < 8 || h == 12 || h == 13 ? d.x : d.y, v = h < 4 || h == 12 || h == 13 ? d.y : d.z;
    return ((h & 1) ? -u : u) + ((h & 2) ? -v : v);
}

double noise(const Vec3d& p) {
    const Vec3d cell = glm::floor(p), d = p - cell, w = d * d * d * (d * (d * 6.0 - 15.0) + 10.0);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const int i = corner & 1, j = (corner >> 1) & 1, k = corner >> 2;
        const double weight = (i ? w.x : 1.0 - w.x) * (j ? w.y : 1.0 - w.y) * (k ? w.z : 1.0 - w.z);
        sum += weight * gradient(int(cell.x) + i, int(cell.y) + j, int(cell.z) + k, d - Vec3d(i, j, k));
    }
    return sum;
}

Vec3d noise_slope(const Vec3d& p) {
    constexpr double delta = 0.01;
    const double n = noise(p);
    return Vec3d(noise(p + Vec3d(delta, 0, 0)) - n, noise(p + Vec3d(0, delta, 0)) - n,
                 noise(p + Vec3d(0, 0, delta)) - n) /
           delta;
}

}  // namespace

double pbrt_cloud_density(const Vec3d& p, double density, double wispiness, double frequency) {
    if (!(glm::length(frequency * p) < 1e6)) return 0.0;
    Vec3d at = frequency * p;
    double omega = 0.05 * wispiness, lambda = 10.0;
    for (int i = 0; i < 2 && wispiness > 0.0; ++i) {
        at += omega * noise_slope(lambda * at);
        omega *= 0.5, lambda *= 1.99;
    }
    double d = 0.0;
    omega = 0.5, lambda = 1.0;
    for (int i = 0; i < 5; ++i) {
        d += omega * noise(lambda * at);
        omega *= 0.5, lambda *= 1.99;
    }
    d = std::clamp((1.0 - p.y) * 4.5 * density * d, 0.0, 1.0) + 2.0 * std::max(0.0, 0.5 - p.y);
    return std::clamp(d, 0.0, 1.0);
}

}  // namespace mote::core
