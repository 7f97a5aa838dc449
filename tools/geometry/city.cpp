#include "tools/geometry/city.h"

#include <algorithm>

#include "core/math/random.h"
#include "tools/geometry/facade.h"
#include "tools/geometry/plants.h"

namespace mote::tools {
namespace {

using core::lerp;
using core::Rng;

constexpr float pitch = 60.0f, street = 14.0f, curb = 0.15f;
constexpr float lot = 0.5f * (pitch - street) - 3.0f;  // half width of the built part of a block

/// Houses in a row around a yard: the older quarters.
void add_perimeter(Parts& parts, const Vec3& middle, Rng& rng) {
    static const char* walls[] = {"brick", "stucco", "stone", "stucco", "brick"};
    constexpr float deep = 10.5f;
    for (int side = 0; side < 4; ++side) {
        // Every side takes one corner and leaves the next one free.
        float from = -lot;
        const float to = lot - deep;
        for (int houses = 2; houses > 0; --houses) {
            const float width = houses == 1 ? to - from : (to - from) * lerp(0.4f, 0.6f, rng.next_float());
            const float height = 3.3f * float(3 + int(4.0f * rng.next_float()));
            // Along the side, from the front to the yard; turned into place by swapping axes.
            const Vec2 low(from, lot - deep), high(from + width, lot);
            const Vec2 corners[2] = {low, high};
            const auto turned = [&](const Vec2& p) {
                const Vec2 directions[4] = {{p.x, p.y}, {p.y, -p.x}, {-p.x, -p.y}, {-p.y, p.x}};
                return middle + Vec3(directions[side].x, curb, directions[side].y);
            };
            const Vec3 p = turned(corners[0]), q = turned(corners[1]);
            const Vec3 lower = glm::min(p, q), upper = glm::max(p, q) + Vec3(0.0f, height, 0.0f);
            const Style style{walls[int(5.0f * rng.next_float())], 3.3f,  4.05f + 0.75f * rng.next_float(),
                              0.38f + 0.1f * rng.next_float(),     0.55f, 0.2f};
            add_walls(parts, style, lower, upper);
            if (rng.next_float() < 0.7f) {
                add_hipped_roof(parts, style.wall, lower, upper, 3.0f + 1.2f * rng.next_float());
            } else {
                add_flat_roof(parts, style.wall, lower, upper, rng.next_u32());
            }
            from += width;
        }
    }
}

/// A tower that steps back twice, crowned by a mast.
void add_stepped_tower(Parts& parts, const Vec3& middle, float height, Rng& rng) {
    const Style style{rng.next_float() < 0.5f ? "stone" : "concrete", 3.9f, 4.9f, 0.45f, 0.62f, 0.4f};
    float half = lot - 1.0f - 3.0f * rng.next_float(), y = curb, x = half, z = half;
    const float steps[3] = {0.3f, 0.4f, 0.3f};
    for (int i = 0; i < 3; ++i) {
        const Vec3 lower = middle + Vec3(-x, y, -z), upper = middle + Vec3(x, y + steps[i] * height, z);
        add_walls(parts, style, lower, upper);
        add_flat_roof(parts, style.wall, lower, upper, rng.next_u32());
        y = upper.y;
        x *= 0.68f + 0.1f * rng.next_float(), z *= 0.68f + 0.1f * rng.next_float();
    }
    parts["metal"].lathe(middle + Vec3(0, y - 0.1f, 0),
                         {{1.1f, 0.0f}, {0.8f, 4.0f}, {0.35f, 4.2f}, {0.1f, 24.0f}, {0.0f, 24.0f}}, 8);
}

/// Bands of glass from edge to edge.
void add_glass_slab(Parts& parts, const Vec3& middle, float height, Rng& rng) {
    const float x = rng.next_float() < 0.5f ? lot - 2.0f : 11.0f, z = x > 12.0f ? 11.0f : lot - 2.0f;
    const Vec3 lower = middle + Vec3(-x, curb, -z), upper = middle + Vec3(x, curb + height, z);
    add_walls(parts, {"concrete", 3.7f, 5.5f, 0.94f, 0.72f, 0.12f}, lower, upper);
    add_flat_roof(parts, "concrete", lower, upper, rng.next_u32());
    const Vec3 base(lot, 5.0f, lot);  // a low podium under it
    add_walls(parts, {"stone", 5.0f, 5.0f, 0.8f, 0.7f, 0.3f}, middle + Vec3(-base.x, curb, -base.z),
              middle + base);
    add_flat_roof(parts, "stone", middle + Vec3(-base.x, 0, -base.z), middle + base, rng.next_u32());
}

/// A round tower of rings.
void add_round_tower(Parts& parts, const Vec3& middle, float height, Rng& rng) {
    const float radius = 12.0f + 4.0f * rng.next_float(), storey = 3.8f;
    const int floors = int(height / storey), around = 40;
    for (int i = 0; i < floors; ++i) {
        const float y = curb + storey * float(i), t = float(i) / float(floors),
                    r = radius * (1.0f - 0.25f * t * t);
        parts["concrete"].lathe(
            middle, {{r - 0.5f, y}, {r + 0.4f, y}, {r + 0.4f, y + 0.9f}, {r - 0.5f, y + 0.9f}}, around);
        parts["glass"].lathe(middle, {{r - 0.4f, y + 0.9f}, {r - 0.4f, y + storey}}, around);
    }
    const float top = curb + storey * float(floors), r = 0.75f * radius;
    parts["metal"].lathe(
        middle, {{r + 0.6f, top}, {r + 0.6f, top + 1.2f}, {0.6f * r, top + 5.0f}, {0.0f, top + 6.0f}},
        around);
}

using Trees = std::array<Parts, 4>;
Trees make_trees(Rng& rng) {
    Trees trees;
    for (Parts& tree : trees) {
        tree["bark"].lathe({}, {{0.22f, -0.1f}, {0.15f, 1.2f}, {0.1f, 3.4f}, {0.0f, 3.5f}}, 6);
        tree["leaves"].add(make_bush(1.9f, 5.0f, 44, rng), {{0.0f, 1.9f, 0.0f}});
    }
    return trees;
}

void add_tree(Parts& parts, const Trees& trees, const Vec3& at, Rng& rng) {
    add_parts(parts, trees[rng.next_u32() % 4],
              {at, 6.0f * rng.next_float(), 0.9f + 0.7f * rng.next_float()});
}

void add_park(Parts& parts, const Trees& trees, const Vec3& middle, Rng& rng) {
    const Vec3 half(lot + 1.0f, 0.0f, lot + 1.0f), up(0.0f, curb + 0.03f, 0.0f);
    parts["grass"].box(middle - half, middle + half + up);
    parts["water"].lathe(middle + up, {{8.0f, 0.02f}, {0.0f, 0.02f}}, 32);
    parts["stone"].lathe(middle + up, {{8.6f, -0.05f}, {8.6f, 0.25f}, {8.0f, 0.25f}, {8.0f, -0.05f}}, 32);
    for (int i = 0; i < 26; ++i) {
        const Vec2 p = (2.0f * rng.next_vec2() - 1.0f) * (lot - 1.0f);
        if (glm::length(p) > 11.0f) add_tree(parts, trees, middle + up + Vec3(p.x, 0.0f, p.y), rng);
    }
}

void add_car(Parts& parts, const Vec3& at, bool along_x, Rng& rng) {
    static const char* colours[] = {"metal", "white", "car", "white", "car"};
    const auto size = [&](float length, float y, float width) {
        return along_x ? Vec3(length, y, width) : Vec3(width, y, length);
    };
    Soup& body = parts[colours[int(5.0f * rng.next_float())]];
    body.box(at + size(-2.1f, 0.3f, -0.85f), at + size(2.1f, 0.85f, 0.85f));
    parts["glass"].box(at + size(-1.3f, 0.84f, -0.75f), at + size(1.0f, 1.3f, 0.75f));
    body.box(at + size(-1.25f, 1.29f, -0.75f), at + size(0.95f, 1.4f, 0.75f));
}

/// Adds pavements, and what lies and stands along the streets on two sides of a block.
void add_streets(Parts& parts, const Trees& trees, const Vec3& middle, Rng& rng) {
    const float edge = 0.5f * pitch, walk = 0.5f * (pitch - street);
    parts["pavement"].box(middle - Vec3(walk, 0.5f, walk), middle + Vec3(walk, curb, walk));
    for (int i = 0; i < 6; ++i) {
        const float s = -edge + street * 0.5f + 4.0f + 8.0f * float(i), y = 0.02f;
        for (const bool along_x : {true, false}) {
            const auto at = [&](float along, float across) {
                return middle + (along_x ? Vec3(along, 0, across) : Vec3(across, 0, along));
            };
            const Vec3 mark = along_x ? Vec3(1.5f, 0.0f, 0.08f) : Vec3(0.08f, 0.0f, 1.5f);
            parts["white"].box(at(s, edge) - mark, at(s, edge) + mark + Vec3(0, y, 0));
            for (const float side : {-1.0f, 1.0f}) {
                if (rng.next_float() < 0.3f)
                    add_car(parts, at(s + 2.0f * rng.next_float(), edge + side * 2.2f), along_x, rng);
                if (i % 3 == 1 && rng.next_float() < 0.55f)
                    add_tree(parts, trees, at(s, edge + side * 8.2f) + Vec3(0, curb, 0), rng);
            }
        }
    }
}

/// `far`: from the middle of the towers, in blocks of a town of eleven.
void add_block(Parts& parts, const Trees& trees, const Vec3& middle, float far, Rng& rng) {
    add_streets(parts, trees, middle, rng);
    const float chance = rng.next_float();
    const float height = lerp(175.0f, 50.0f, std::min(1.0f, far / 3.6f)) * (0.75f + 0.4f * rng.next_float());
    if (far > 0.8f && chance < 0.08f) return add_park(parts, trees, middle, rng);
    if (chance > 0.95f - 0.32f * std::exp(-0.4f * far))
        return add_glass_slab(parts, middle, 0.8f * height, rng);
    if (far < 2.1f && chance > 0.3f) return add_stepped_tower(parts, middle, height, rng);
    if (far < 3.4f && chance < 0.2f) return add_round_tower(parts, middle, height, rng);
    if (far < 2.6f && chance < 0.45f) return add_stepped_tower(parts, middle, 0.6f * height, rng);
    add_perimeter(parts, middle, rng);
}

}  // namespace

Parts make_city(float detail, std::uint64_t seed) {
    Parts parts;
    Rng common(core::hash_keys(seed, 0x74726565ull));
    const Trees trees = make_trees(common);
    const int blocks = segments(11.0f, std::sqrt(detail), 2);
    for (int k = 0; k < blocks; ++k)
        for (int i = 0; i < blocks; ++i) {
            // Every block has its own numbers: those of one do not depend on its neighbours.
            const Vec3 middle(pitch * (float(i) - 0.5f * float(blocks - 1)), 0.0f,
                              pitch * (float(k) - 0.5f * float(blocks - 1)));
            Rng rng(core::hash_keys(seed, i - blocks / 2, k - blocks / 2));
            if (i == blocks - 1 - blocks / 4 && k == blocks - 1 - blocks / 5) {  // every town has a park
                add_streets(parts, trees, middle, rng);
                add_park(parts, trees, middle, rng);
                continue;
            }
            const float shrunk = 11.0f / float(blocks);
            const Vec2 from_towers = shrunk * Vec2(middle.x, middle.z) / pitch + Vec2(1.0f, -0.5f);
            add_block(parts, trees, middle, glm::length(from_towers), rng);
        }
    const float half = 0.5f * pitch * float(blocks) + 60.0f;
    parts["asphalt"].box({-half, -1.0f, -half}, {half, 0.0f, half});
    return parts;
}

}  // namespace mote::tools
