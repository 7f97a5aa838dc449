#include "tools/geometry/atrium.h"

#include "tools/geometry/cloth.h"
#include "tools/geometry/masonry.h"
#include "tools/geometry/plants.h"
#include "tools/geometry/vessels.h"

namespace mote::tools {
namespace {

using core::Rng;

constexpr float bay = 4.0f;
constexpr int columns_x = 9, columns_z = 5;  // bays, of which the outer ring is the gallery
constexpr float left = -0.5f * bay * columns_x, back = -0.5f * bay * columns_z;

struct Storey {
    float floor, springing, ceiling;  // heights; the slab lies between this ceiling and the next floor
    Column column;
};
const Storey storeys[2] = {{0.0f, 3.7f, 5.75f, {3.7f, 0.27f, 0.86f, 0.0f}},
                           {6.3f, 8.9f, 10.95f, {2.6f, 0.17f, 0.62f, 0.75f}}};

bool in_building(int i, int k) { return i >= 0 && i < columns_x && k >= 0 && k < columns_z; }
bool in_court(int i, int k) { return i > 0 && i < columns_x - 1 && k > 0 && k < columns_z - 1; }
bool in_gallery(int i, int k) { return in_building(i, k) && !in_court(i, k); }
Vec3 node(int i, int k, float y) { return {left + bay * float(i), y, back + bay * float(k)}; }
bool court_at(float x, float z) { return std::fabs(x) < -left - bay && std::fabs(z) < -back - bay; }

/// The wall between two neighbouring bays, of which at least one is gallery: an arch inside the building,
/// solid around it.
void add_partition(Parts& parts, const Storey& s, const Vec3& a, const Vec3& b, bool outer, float detail) {
    if (!outer) return add_arch_wall(parts, {a, b, s.ceiling, 0.5f, 1.57f}, detail);
    const Vec3 lower = glm::min(a, b), upper = glm::max(a, b),
               out = Vec3(b.z == a.z ? 0.0f : 0.3f, 0.0f, b.z == a.z ? 0.3f : 0.0f);
    parts["wall"].box(Vec3(lower.x, s.floor - 0.5f, lower.z) - out,
                      Vec3(upper.x, s.ceiling + 0.5f, upper.z) + out);
}

/// A half pillar against the outer wall, under the springing of two vaults.
void add_pilaster(Soup& soup, const Vec3& at, float height) {
    const auto block = [&](float half, float from, float to) {
        soup.box(at + Vec3(-half, from, -half), at + Vec3(half, to, half));
    };
    block(0.5f, 0.0f, 0.35f), block(0.46f, 0.35f, 0.42f), block(0.4f, 0.42f, height - 0.3f);
    block(0.44f, height - 0.3f, height - 0.2f), block(0.5f, height - 0.2f, height);
}

void add_storey(Parts& parts, const Storey& s, float detail) {
    const Soup column = make_column(s.column, detail);
    for (int k = 0; k <= columns_z; ++k)
        for (int i = 0; i <= columns_x; ++i) {
            const int galleries =
                in_gallery(i - 1, k - 1) + in_gallery(i, k - 1) + in_gallery(i - 1, k) + in_gallery(i, k);
            const bool rim = i == 0 || k == 0 || i == columns_x || k == columns_z;
            if (rim) add_pilaster(parts["stone"], node(i, k, s.floor), s.springing - s.floor);
            if (!rim && galleries > 0) parts["marble"].add(column, {node(i, k, s.floor)});
            if (i < columns_x && (in_gallery(i, k) || in_gallery(i, k - 1)))
                add_partition(parts, s, node(i, k, s.springing), node(i + 1, k, s.springing),
                              !in_building(i, k) || !in_building(i, k - 1), detail);
            if (k < columns_z && (in_gallery(i, k) || in_gallery(i - 1, k)))
                add_partition(parts, s, node(i, k, s.springing), node(i, k + 1, s.springing),
                              !in_building(i, k) || !in_building(i - 1, k), detail);
            if (!in_gallery(i, k)) continue;
            const Vec3 inset(0.25f, 0.0f, 0.25f);
            add_vault(parts["plaster"], node(i, k, s.springing) + inset,
                      node(i + 1, k + 1, s.springing) - inset, 1.75f, detail);
            parts["wall"].box(node(i, k, s.ceiling - 0.02f), node(i + 1, k + 1, s.ceiling + 0.5f));
        }
}

/// Mouldings around the court, at the slab of a storey.
void add_cornice(Soup& soup, float y, float reach) {
    const Vec3 lower(left + bay, 0, back + bay), upper = -lower;
    const float r = reach;
    // The walls stand 0.25 m out into the court.
    soup.frame(lower, upper,
               {{-0.2f, y - 0.1f},
                {-0.25f - 0.3f * r, y},
                {-0.25f - 0.35f * r, y + 0.08f},
                {-0.25f - 0.65f * r, y + 0.16f},
                {-0.25f - 0.65f * r, y + 0.22f},
                {-0.25f - r, y + 0.3f},
                {-0.25f - r, y + 0.42f},
                {0.0f, y + 0.46f}},
               true);
    for (const float side : {-1.0f, 1.0f}) {  // brackets under it
        const float inner_z = upper.z - 0.25f, inner_x = upper.x - 0.25f;
        for (float x = -inner_x + 0.4f; x < inner_x - 0.3f; x += 0.5f) {
            const float z0 = side * inner_z, z1 = side * (inner_z - 0.75f * r);
            soup.box({x - 0.07f, y - 0.08f, std::fmin(z0, z1)}, {x + 0.07f, y + 0.14f, std::fmax(z0, z1)});
        }
        for (float z = -inner_z + 0.4f; z < inner_z - 0.3f; z += 0.5f) {
            const float x0 = side * inner_x, x1 = side * (inner_x - 0.75f * r);
            soup.box({std::fmin(x0, x1), y - 0.08f, z - 0.07f}, {std::fmax(x0, x1), y + 0.14f, z + 0.07f});
        }
    }
}

/// Calls f for every side of a bay that lies between gallery and court, from left to right seen from the
/// court; `inwards` points into the court.
template <typename F>
void for_each_opening(const F& f) {
    int number = 0;
    for (int i = 1; i < columns_x - 1; ++i) f(number++, node(i, 1, 0), node(i + 1, 1, 0), Vec3(0, 0, 1));
    for (int k = 1; k < columns_z - 1; ++k)
        f(number++, node(columns_x - 1, k, 0), node(columns_x - 1, k + 1, 0), Vec3(-1, 0, 0));
    for (int i = columns_x - 1; i > 1; --i)
        f(number++, node(i, columns_z - 1, 0), node(i - 1, columns_z - 1, 0), Vec3(0, 0, -1));
    for (int k = columns_z - 1; k > 1; --k) f(number++, node(1, k, 0), node(1, k - 1, 0), Vec3(1, 0, 0));
}

void add_balustrades(Parts& parts, float detail) {
    const Soup baluster = make_baluster(0.74f, detail);
    const float floor = storeys[1].floor;
    for_each_opening([&](int, const Vec3& a, const Vec3& b, const Vec3&) {
        const Vec3 along = (b - a) / bay, across = 0.11f * Vec3(std::fabs(along.z), 0.0f, std::fabs(along.x));
        const auto rail = [&](float from, float to, float wide) {
            const Vec3 s = a + 0.25f * along, e = b - 0.25f * along;
            parts["stone"].box(glm::min(s, e) - wide * across + Vec3(0, floor + from, 0),
                               glm::max(s, e) + wide * across + Vec3(0, floor + to, 0));
        };
        rail(0.0f, 0.12f, 1.0f), rail(0.86f, 0.92f, 0.8f), rail(0.92f, 1.0f, 1.1f);
        for (int j = 0; j < 10; ++j) {
            const Vec3 at = a + along * (0.25f + 3.5f * (float(j) + 0.5f) / 10.0f);
            parts["marble"].add(baluster, {at + Vec3(0, floor + 0.12f, 0)});
        }
    });
}

void add_hangings(Parts& parts, float detail, Rng& rng) {
    static constexpr const char* colours[] = {"cloth_red", "cloth_blue", "cloth_ochre"};
    for_each_opening([&](int number, const Vec3& a, const Vec3& b, const Vec3& inwards) {
        // Curtains above, pulled to one side or to both; banners from the balustrade in every third bay.
        if (number % 2 == 0) {
            const Vec3 along = (b - a) / bay;
            const float wide = 0.7f + 0.5f * rng.next_float();
            const auto curtain = [&](float from, float to) {
                add_curtain(
                    parts[colours[number / 2 % 3]],
                    {a + from * along + Vec3(0, 9.05f, 0), a + to * along + Vec3(0, 9.05f, 0), 2.65f, 7}, rng,
                    detail);
            };
            curtain(0.35f, 0.35f + wide), curtain(bay - 0.35f - wide, bay - 0.35f);
            parts["bronze"].add(make_rod(a + 0.25f * along, b - 0.25f * along, 0.03f), {Vec3(0, 9.07f, 0)});
        }
        if (number % 3 == 1) {  // clear of the cornice, from rods that stick out over the balustrade
            const Vec3 middle = 0.5f * (a + b) + 0.72f * inwards, half = 0.6f * (b - a) / bay;
            const Vec3 top(0.0f, 7.15f, 0.0f);
            add_banner(parts[colours[number % 2 ? 0 : 1]],
                       {middle - half + top, middle + half + top, 3.2f, 0}, rng, detail);
            for (const float side : {-1.0f, 1.0f})
                parts["bronze"].add(
                    make_rod(0.5f * (a + b) + side * half, middle + side * half + 0.06f * inwards, 0.025f),
                    {top});
            parts["bronze"].add(make_rod(middle - 1.1f * half, middle + 1.1f * half, 0.025f), {top});
        }
        if (number % 5 == 3) {
            const Vec3 rim = 0.3f * inwards + Vec3(0, 7.25f, 0);
            add_vines(parts["leaves"], a + rim, b + rim, 2.8f, 12, segments(30, detail), rng);
        }
    });
    // Sails over the court: the sun comes in between them.
    for (int i = 0; i < 4; ++i) {
        const float x = -10.4f + 6.6f * float(i);
        add_sail(parts["cloth_sail"], {x - 1.35f, 10.9f, -5.75f}, {x + 1.35f, 10.9f, 5.75f}, 1.5f, rng,
                 detail);
    }
}

void add_court(Parts& parts, float detail, Rng& rng) {
    add_fountain(parts, {0, 0, 0}, detail);
    for (int i = 0; i < 10; ++i) {
        const Vec3 at((float(i % 5) - 2.0f) * 5.4f + (i % 5 == 2 ? 2.6f : 0.0f), 0.0f, i < 5 ? -5.0f : 5.0f);
        const Placement place{at, 6.0f * rng.next_float(), 0.9f + 0.3f * rng.next_float()};
        const Soup pot = make_pot(detail);
        parts["terracotta"].add(pot, place);
        const float soil = pot_soil();
        Placement above = place;
        above.origin.y += soil * place.scale;
        parts["leaves"].add(i % 3 == 1 ? make_tuft(0.95f, segments(50, detail), rng, detail)
                                       : make_bush(0.5f, 1.15f, segments(520, detail), rng),
                            above);
    }
    for (int i = 0; i < 6; ++i)  // lamps in the galleries
        add_lantern(parts, {(float(i % 3) - 1.0f) * 8.0f, 5.45f, i < 3 ? -8.0f : 8.0f}, 2.1f, detail);
}

void add_floors_and_roof(Parts& parts) {
    const Vec3 lower(left, 0, back), upper = -lower;
    Soup& wall = parts["wall"];
    wall.box({left - 0.3f, -0.5f, back - 0.3f}, {-left + 0.3f, -0.045f, -back + 0.3f});
    add_paving(parts["marble"], parts["red"], lower + Vec3(0, -0.05f, 0), upper, 0.5f, court_at);
    const auto gallery = [](float x, float z) { return !court_at(x, z); };
    add_paving(parts["stone"], parts["dark"], lower + Vec3(0, -0.05f, 0), upper, 1.0f, gallery);
    add_paving(parts["stone"], parts["red"], lower + Vec3(0, 6.25f, 0), upper + Vec3(0, 6.3f, 0), 1.0f,
               gallery);
    add_cornice(parts["stone"], 5.7f, 0.35f);
    add_cornice(parts["stone"], 10.9f, 0.7f);
    // A parapet around the opening, and the roof outside it.
    parts["stone"].frame(
        lower + Vec3(bay, 0, bay), upper - Vec3(bay, 0, bay),
        {{-0.3f, 11.3f}, {-0.3f, 12.2f}, {-0.4f, 12.3f}, {-0.4f, 12.6f}, {0.3f, 12.6f}, {0.3f, 11.3f}}, true);
    parts["red"].frame(lower, upper, {{-bay, 12.0f}, {0.3f, 11.4f}, {0.3f, 11.2f}}, false);
}

}  // namespace

Parts make_atrium(float detail, std::uint64_t seed) {
    Parts parts;
    Rng rng(core::hash_keys(seed, 0x617472ull));
    for (const Storey& storey : storeys) add_storey(parts, storey, detail);
    add_floors_and_roof(parts);
    add_balustrades(parts, detail);
    add_hangings(parts, detail, rng);
    add_court(parts, detail, rng);
    return parts;
}

}  // namespace mote::tools
