#include "tools/geometry/facade.h"

#include <algorithm>

#include "core/math/random.h"

namespace mote::tools {

void add_facade(Soup& wall, Soup& glass, const Facade& f) {
    const float width = glm::length(f.along), cell = width / float(f.columns),
                storey = f.height / float(f.floors);
    const Vec3 right = f.along / width, back(right.z, 0.0f, -right.x);  // into the building
    const auto at = [&](float s, float y, float d) {
        return f.foot + s * right + Vec3(0.0f, y, 0.0f) + d * back;
    };
    const auto flat = [&](float s0, float y0, float s1, float y1) {
        wall.quad(at(s0, y0, 0), at(s1, y0, 0), at(s1, y1, 0), at(s0, y1, 0));
    };
    const float pier = 0.5f * cell * (1.0f - f.window_width),
                sill = 0.55f * storey * (1.0f - f.window_height);
    const float tall = storey * f.window_height, d = f.recess;
    for (int j = 0; j < f.floors; ++j) {
        const float y0 = float(j) * storey + sill, y1 = y0 + tall;
        flat(0.0f, float(j) * storey, width, y0);
        flat(0.0f, y1, width, float(j + 1) * storey);
        for (int i = 0; i <= f.columns; ++i)
            flat(i == 0 ? 0.0f : float(i) * cell - pier, y0, i == f.columns ? width : float(i) * cell + pier,
                 y1);
        for (int i = 0; i < f.columns; ++i) {
            const float s0 = float(i) * cell + pier, s1 = float(i + 1) * cell - pier;
            wall.quad(at(s0, y0, 0), at(s1, y0, 0), at(s1, y0, d), at(s0, y0, d));
            wall.quad(at(s1, y1, 0), at(s0, y1, 0), at(s0, y1, d), at(s1, y1, d));
            wall.quad(at(s0, y1, 0), at(s0, y0, 0), at(s0, y0, d), at(s0, y1, d));
            wall.quad(at(s1, y0, 0), at(s1, y1, 0), at(s1, y1, d), at(s1, y0, d));
            glass.quad(at(s0, y0, d), at(s1, y0, d), at(s1, y1, d), at(s0, y1, d));
        }
    }
}

void add_walls(Parts& parts, const Style& style, const Vec3& lower, const Vec3& upper) {
    const float height = upper.y - lower.y;
    const int floors = std::max(1, int(std::lround(height / style.storey)));
    const Vec3 corners[4] = {{lower.x, lower.y, upper.z},
                             {upper.x, lower.y, upper.z},
                             {upper.x, lower.y, lower.z},
                             {lower.x, lower.y, lower.z}};
    for (int k = 0; k < 4; ++k) {
        const Vec3 along = corners[(k + 1) % 4] - corners[k];
        const int columns = std::max(1, int(glm::length(along) / style.cell));
        add_facade(parts[style.wall], parts["glass"],
                   {corners[k], along, height, floors, columns, style.window_width, style.window_height,
                    style.recess});
    }
}

void add_flat_roof(Parts& parts, const std::string& wall, const Vec3& lower, const Vec3& upper,
                   std::uint64_t seed) {
    core::Rng rng(seed);
    const float y = upper.y, w = upper.x - lower.x, d = upper.z - lower.z;
    parts[wall].frame({lower.x, 0, lower.z}, {upper.x, 0, upper.z},
                      {{0.0f, y}, {0.12f, y}, {0.12f, y + 0.9f}, {-0.35f, y + 0.9f}, {-0.35f, y}}, false);
    parts["gravel"].quad({lower.x, y, upper.z}, {upper.x, y, upper.z}, {upper.x, y, lower.z},
                         {lower.x, y, lower.z});
    if (std::fmin(w, d) < 7.0f) return;
    const auto spot = [&](float margin) {
        return Vec3(core::lerp(lower.x + margin, upper.x - margin, rng.next_float()), y,
                    core::lerp(lower.z + margin, upper.z - margin, rng.next_float()));
    };
    const Vec3 hut = spot(3.2f);
    parts[wall].box(hut - Vec3(2.0f, 0.02f, 1.5f), hut + Vec3(2.0f, 2.8f, 1.5f));
    for (int i = int(4.0f * rng.next_float()); i >= 0; --i) {
        const Vec3 at = spot(1.6f),
                   half(0.5f + 0.6f * rng.next_float(), 0.0f, 0.5f + 0.4f * rng.next_float());
        parts["metal"].box(at - half - Vec3(0, 0.02f, 0),
                           at + half + Vec3(0, 0.8f + 0.7f * rng.next_float(), 0));
    }
    if (rng.next_float() < 0.35f) {  // a water tank on legs
        const Vec3 at = spot(2.5f);
        for (int k = 0; k < 4; ++k) {
            const Vec3 leg = at + Vec3(k & 1 ? 0.9f : -0.9f, 0.0f, k & 2 ? 0.9f : -0.9f);
            parts["metal"].box(leg - Vec3(0.08f, 0.02f, 0.08f), leg + Vec3(0.08f, 2.0f, 0.08f));
        }
        parts["wood"].lathe(at, {{0.0f, 2.0f}, {1.5f, 2.0f}, {1.5f, 4.6f}, {1.65f, 4.6f}, {0.0f, 5.6f}}, 14);
    }
}

void add_hipped_roof(Parts& parts, const std::string& wall, const Vec3& lower, const Vec3& upper,
                     float rise) {
    const float y = upper.y, eaves = 0.5f;
    const Vec3 a(lower.x - eaves, y, lower.z - eaves), b(upper.x + eaves, y, upper.z + eaves);
    const float w = b.x - a.x, d = b.z - a.z, run = 0.5f * std::fmin(w, d);
    // The ridge, a line along the longer side.
    const Vec3 r0(a.x + run, y + rise, a.z + run), r1(b.x - run, y + rise, b.z - run);
    Soup& tiles = parts["tiles"];
    const Vec3 c[4] = {{a.x, y, b.z}, {b.x, y, b.z}, {b.x, y, a.z}, {a.x, y, a.z}};
    const bool long_x = w >= d;
    const Vec3 top[4] = {long_x ? r0 : r1, r1, long_x ? r1 : r0, r0};  // the ridge's end over every corner
    for (int k = 0; k < 4; ++k) tiles.quad(c[k], c[(k + 1) % 4], top[(k + 1) % 4], top[k]);
    parts[wall].frame({a.x, 0, a.z}, {b.x, 0, b.z},
                      {{-eaves - 0.1f, y - 0.35f}, {-0.1f, y - 0.25f}, {0.0f, y}}, false);
    const Vec3 chimney = glm::mix(r0, r1, 0.3f) + Vec3(0.8f, 0.0f, 0.8f);
    parts["brick"].box(chimney - Vec3(0.4f, 2.0f, 0.4f), chimney + Vec3(0.4f, 1.2f, 0.4f));
}

}  // namespace mote::tools
