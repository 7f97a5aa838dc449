#include "tools/geometry/window.h"

#include "tools/geometry/masonry.h"
#include "tools/geometry/plants.h"
#include "tools/geometry/vessels.h"

namespace mote::tools {

Parts make_window(float detail, std::uint64_t seed) {
    constexpr float sill = 0.9f, springing = 2.5f, top = 4.4f, radius = 0.75f, pitch = 2.2f, half = 0.25f;
    Parts parts;
    Soup& wall = parts["wall"];
    wall.box({-4.0f, 0.0f, -half}, {4.0f, sill, half});
    parts["stone"].box({-3.4f, sill - 0.08f, -half - 0.06f}, {3.4f, sill + 0.01f, half + 0.08f});
    for (const float side : {-1.0f, 1.0f}) {  // beside the outer windows, from floor to ceiling
        const float a = side * 4.0f, b = side * 1.5f * pitch;
        wall.box({std::fmin(a, b), sill - 0.01f, -half}, {std::fmax(a, b), top, half});
    }
    for (int i = -1; i <= 1; ++i) {
        const float x = pitch * float(i);
        add_arch_wall(
            parts,
            {{x - 0.5f * pitch, springing, 0}, {x + 0.5f * pitch, springing, 0}, top, 2.0f * half, radius},
            detail);
        for (const float side : {-1.0f, 1.0f}) {
            const float a = x + side * radius, b = x + side * 0.5f * pitch;
            wall.box({std::fmin(a, b), sill - 0.01f, -half}, {std::fmax(a, b), springing + 0.01f, half});
        }
        for (int k = 1; k < 6; ++k) {  // bars up to the arch
            const float s = radius * (float(k) / 3.0f - 1.0f),
                        rise = core::safe_sqrt(radius * radius - s * s);
            parts["iron"].add(make_rod({x + s, sill, 0}, {x + s, springing + rise, 0}, 0.018f), {});
        }
        for (int k = 1; k < 7; ++k) {
            const float y = sill + 0.38f * float(k);
            const float reach =
                y < springing ? radius : core::safe_sqrt(radius * radius - core::sqr(y - springing));
            parts["iron"].add(make_rod({x - reach, y, 0}, {x + reach, y, 0}, 0.018f), {});
        }
    }
    core::Rng rng(core::hash_keys(seed, 0x706f74ull));
    for (const Vec3& at : {Vec3(-1.1f, 0.0f, 1.3f), Vec3(2.4f, 0.0f, 2.2f)}) {
        parts["terracotta"].add(make_pot(detail), {at});
        parts["leaves"].add(make_bush(0.5f, 1.1f, segments(500, detail), rng), {at + Vec3(0, pot_soil(), 0)});
    }
    return parts;
}

}  // namespace mote::tools
