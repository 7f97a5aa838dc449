#include "tools/geometry/masonry.h"

#include <cmath>

namespace mote::tools {
namespace {

using core::lerp;
using core::pi;

/// A half-round moulding bulging out of a profile, from one height to the next.
void add_torus(std::vector<Vec2>& profile, float radius, float from, float to, int steps) {
    for (int i = 0; i <= steps; ++i) {
        const float angle = pi * float(i) / float(steps);
        profile.emplace_back(radius + 0.5f * (to - from) * std::sin(angle),
                             from + 0.5f * (to - from) * (1.0f - std::cos(angle)));
    }
}

/// The distance from the middle to the rim of a square of half width 1 with rounded corners: 0 is a circle.
float squareness(float angle, float amount) {
    const float power = 2.0f + 14.0f * amount;
    const float c = std::fabs(std::cos(angle)), s = std::fabs(std::sin(angle));
    return std::pow(std::pow(c, power) + std::pow(s, power), -1.0f / power);
}

void centred_box(Soup& soup, float half, float bottom, float top) {
    soup.box({-half, bottom, -half}, {half, top, half});
}

}  // namespace

Soup make_column(const Column& c, float detail) {
    Soup soup;
    const int around = segments(20, detail, 5), curve = segments(4, detail, 2);
    const float r = c.radius, base = 1.1f * r, bell = c.height - 0.34f * c.abacus - 2.2f * r;
    centred_box(soup, 1.55f * r, 0.0f, 0.4f * r);
    std::vector<Vec2> foot{{0.0f, 0.4f * r}};
    add_torus(foot, 1.25f * r, 0.4f * r, 0.8f * r, curve);
    add_torus(foot, 1.1f * r, 0.85f * r, base, curve);
    foot.emplace_back(r, base);
    soup.lathe({}, foot, around);

    const int flutes = 6, turning = c.twist == 0.0f ? around : segments(24, detail, 5);
    const int rings = segments(c.twist == 0.0f ? 6 : 16, detail, 2);
    soup.lathe({}, rings, turning, [&](float t, float angle) {
        const float entasis = r * (1.0f - 0.14f * t * t);
        const float wave =
            c.twist == 0.0f
                ? 0.0f
                : std::cos(float(flutes) * angle + 2.0f * pi * c.twist * t * float(flutes) / 2.0f);
        return Vec2(entasis * (1.0f - 0.09f + 0.09f * wave), lerp(base - 0.02f * r, bell, t));
    });
    std::vector<Vec2> collar{{0.8f * r, bell - 0.1f * r}};
    add_torus(collar, 0.92f * r, bell - 0.08f * r, bell + 0.17f * r, curve);
    collar.emplace_back(0.7f * r, bell + 0.18f * r);
    soup.lathe({}, collar, around);
    // The bell: leaves curl out of it in two rows.
    const float rim = c.height - 0.17f * c.abacus;
    soup.lathe({}, segments(8, detail, 3), segments(22, detail, 8), [&](float t, float angle) {
        const float flare = t * t * (3.0f - 2.0f * t);
        const float curl = 0.09f * r * std::fabs(std::cos(4.0f * angle + (t < 0.5f ? 0.0f : 0.5f * pi))) *
                           std::sin(2.0f * pi * std::fmod(t, 0.5f));
        return Vec2(lerp(0.86f * r, 0.5f * c.abacus * squareness(angle, flare), flare) + 2.0f * curl,
                    lerp(bell + 0.1f * r, rim, t));
    });
    centred_box(soup, 0.5f * c.abacus, rim, rim + 0.08f * c.abacus);
    centred_box(soup, 0.54f * c.abacus, rim + 0.08f * c.abacus, c.height);
    return soup;
}

void add_arch_wall(Parts& parts, const ArchWall& w, float detail) {
    const float length = glm::length(w.b - w.a), middle = 0.5f * length;
    const Vec3 along = (w.b - w.a) / length, across(-along.z, 0.0f, along.x);  // along, up, across
    const auto at = [&](float s, float y, float d) {
        return Vec3(w.a.x, w.a.y + y, w.a.z) + s * along + d * across;
    };
    const float top = w.top - w.a.y, half = 0.5f * w.thickness;
    Soup& wall = parts["wall"];
    const auto both_faces = [&](float s0, float bottom0, float s1, float bottom1) {
        wall.quad(at(s0, bottom0, half), at(s1, bottom1, half), at(s1, top, half), at(s0, top, half));
        wall.quad(at(s1, bottom1, -half), at(s0, bottom0, -half), at(s0, top, -half), at(s1, top, -half));
    };
    both_faces(0.0f, 0.0f, middle - w.radius, 0.0f);
    both_faces(middle + w.radius, 0.0f, length, 0.0f);
    const int steps = segments(20, detail, 4);
    for (int i = 0; i < steps; ++i) {
        const float angle0 = pi * float(i) / float(steps), angle1 = pi * float(i + 1) / float(steps);
        const float s0 = middle - w.radius * std::cos(angle0), s1 = middle - w.radius * std::cos(angle1);
        const float y0 = w.radius * std::sin(angle0), y1 = w.radius * std::sin(angle1);
        both_faces(s0, y0, s1, y1);
        wall.quad(at(s1, y1, half), at(s0, y0, half), at(s0, y0, -half), at(s1, y1, -half));
    }
    const auto underside = [&](float s0, float s1) {
        wall.quad(at(s0, 0, -half), at(s1, 0, -half), at(s1, 0, half), at(s0, 0, half));
    };
    underside(0.0f, middle - w.radius);
    underside(middle + w.radius, length);

    constexpr int stones = 19;
    const float inner = w.radius - 0.02f, outer = w.radius + 0.26f, out = half + 0.03f;
    for (int i = 0; i < stones; ++i) {
        Soup& ring = parts[i % 2 ? "red" : "stone"];
        const int bends = segments(1, detail, 1);
        for (int k = 0; k < bends; ++k) {
            const float gap = 0.006f;
            const auto angle_at = [&](int step) {
                const float t = float(step) / float(bends);
                return pi * (float(i) + lerp(gap * float(stones) / 2, 1.0f - gap * float(stones) / 2, t)) /
                       float(stones);
            };
            std::array<Vec3, 8> corners;
            for (int c = 0; c < 8; ++c) {
                const float angle = angle_at(c & 1 ? k + 1 : k), r = c & 2 ? outer : inner;
                corners[c] = at(middle - r * std::cos(angle), r * std::sin(angle), c & 4 ? out : -out);
            }
            ring.hexahedron(corners);
        }
    }
}

void add_vault(Soup& soup, const Vec3& lower, const Vec3& upper, float rise, float detail) {
    const int n = 2 * segments(7, detail, 2);  // even, so that the groins lie on edges of triangles
    // Angles at equal steps, for the arch is steep at its springing.
    const auto across = [](float t) { return -std::cos(pi * t); };
    const auto height = [&](float u, float v) {
        return rise * std::fmax(core::safe_sqrt(1.0f - u * u), core::safe_sqrt(1.0f - v * v));
    };
    const auto point = [&](int i, int j) {
        const float u = across(float(i) / float(n)), v = across(float(j) / float(n));
        return Vec3(lerp(lower.x, upper.x, 0.5f + 0.5f * u), lower.y + height(u, v),
                    lerp(lower.z, upper.z, 0.5f + 0.5f * v));
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Vec3 a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1), d = point(i, j + 1);
            if ((i < n / 2) == (j < n / 2)) {
                soup.triangle(a, b, c), soup.triangle(a, c, d);
            } else {
                soup.triangle(a, b, d), soup.triangle(b, c, d);
            }
        }
}

Soup make_baluster(float height, float detail) {
    Soup soup;
    soup.box({-0.07f, 0.0f, -0.07f}, {0.07f, 0.05f, 0.07f});
    soup.box({-0.07f, height - 0.05f, -0.07f}, {0.07f, height, 0.07f});
    soup.lathe({}, segments(8, detail, 3), segments(7, detail, 3), [&](float t, float) {
        const float belly = std::exp(-core::sqr((t - 0.3f) / 0.17f)),
                    rings = std::exp(-core::sqr((t - 0.8f) / 0.05f));
        return Vec2(0.024f + 0.042f * belly + 0.022f * rings, lerp(0.05f, height - 0.05f, t));
    });
    return soup;
}

void add_paving(Soup& light, Soup& dark, const Vec3& lower, const Vec3& upper, float size,
                const std::function<bool(float, float)>& keep) {
    const int nx = int(std::lround((upper.x - lower.x) / size)),
              nz = int(std::lround((upper.z - lower.z) / size));
    const float bevel = 0.012f, joint = 0.004f, y = upper.y;
    for (int k = 0; k < nz; ++k)
        for (int i = 0; i < nx; ++i) {
            const float x0 = lower.x + size * float(i), z0 = lower.z + size * float(k), x1 = x0 + size,
                        z1 = z0 + size;
            if (!keep(0.5f * (x0 + x1), 0.5f * (z0 + z1))) continue;
            Soup& flag = (i + k) % 2 ? dark : light;
            flag.frame({x0 + bevel, 0, z0 + bevel}, {x1 - bevel, 0, z1 - bevel},
                       {{bevel - joint, lower.y}, {bevel - joint, y - 0.006f}, {0.0f, y}}, false);
            flag.quad({x0 + bevel, y, z1 - bevel}, {x1 - bevel, y, z1 - bevel}, {x1 - bevel, y, z0 + bevel},
                      {x0 + bevel, y, z0 + bevel});
        }
}

}  // namespace mote::tools
