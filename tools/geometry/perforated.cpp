#include "tools/geometry/perforated.h"

#include "tools/geometry/masonry.h"
#include "tools/geometry/plants.h"
#include "tools/geometry/vessels.h"

namespace mote::tools {
namespace {

using core::lerp;
using core::pi;

/// Where a ray from the middle of a cell at this angle leaves the cell, [-0.5, 0.5]^2.
Vec2 cell_border(float c, float s) { return 0.5f * Vec2(c, s) / std::fmax(std::fabs(c), std::fabs(s)); }

/// The radius of a star with eight tips, at a fraction of a turn.
float star(float turn, float inner, float outer) {
    const float t = 8.0f * turn - std::floor(8.0f * turn);
    return lerp(outer, inner, 1.0f - std::fabs(2.0f * t - 1.0f));
}

}  // namespace

void add_perforated(Soup& soup, int nu, int nv, int steps,
                    const std::function<Vec3(float, float, float)>& point) {
    const int around = 8 * steps;
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            const bool large = (i + j) % 2 == 0;
            const auto at = [&](const Vec2& p, float depth) {
                return point((float(i) + 0.5f + p.x) / float(nu), (float(j) + 0.5f + p.y) / float(nv), depth);
            };
            for (int k = 0; k < around; ++k) {
                Vec2 border[2], hole[2];
                for (int end = 0; end < 2; ++end) {
                    const float turn = float((k + end) % around) / float(around);
                    const float c = std::cos(2.0f * pi * turn), s = std::sin(2.0f * pi * turn);
                    border[end] = cell_border(c, s);
                    hole[end] = (large ? star(turn, 0.25f, 0.43f) : star(turn, 0.17f, 0.3f)) * Vec2(c, s);
                }
                soup.quad(at(hole[0], 0), at(border[0], 0), at(border[1], 0), at(hole[1], 0));
                soup.quad(at(border[0], 1), at(hole[0], 1), at(hole[1], 1), at(border[1], 1));
                soup.quad(at(hole[1], 0), at(hole[1], 1), at(hole[0], 1), at(hole[0], 0));
            }
        }
}

Parts make_screen(float detail, std::uint64_t /*seed*/) {
    Parts parts;
    const int across = segments(27.0f, std::sqrt(detail)), up = segments(20.0f, std::sqrt(detail));
    add_perforated(parts["screen"], across, up, segments(12, std::sqrt(detail), 1),
                   [](float u, float v, float depth) {
                       return Vec3(lerp(-3.0f, 3.0f, u), lerp(0.3f, 4.5f, v), -0.03f * depth);
                   });
    Soup& stone = parts["stone"];
    for (const float side : {-1.0f, 1.0f}) {
        Soup post;
        post.box({-0.2f, 0.0f, -0.2f}, {0.2f, 4.8f, 0.2f});
        post.box({-0.28f, 0.0f, -0.28f}, {0.28f, 0.4f, 0.28f});
        post.box({-0.28f, 4.79f, -0.28f}, {0.28f, 5.0f, 0.28f});
        stone.add(post, {{3.19f * side, 0.0f, -0.015f}});
    }
    stone.box({-3.0f, 0.0f, -0.15f}, {3.0f, 0.301f, 0.12f});
    stone.box({-3.0f, 4.499f, -0.15f}, {3.0f, 4.75f, 0.12f});
    return parts;
}

Parts make_lantern(float detail, std::uint64_t /*seed*/) {
    Parts parts;
    const float belt = 1.15f;  // radians up and down from the equator
    const int around = 2 * segments(19.0f, std::sqrt(detail)), up = segments(12.0f, std::sqrt(detail));
    add_perforated(
        parts["shell"], around, up, segments(12, std::sqrt(detail), 1), [&](float u, float v, float depth) {
            const float turn = 2.0f * pi * u, rise = lerp(-belt, belt, v), radius = 0.5f - 0.006f * depth;
            return radius *
                   Vec3(std::cos(rise) * std::cos(turn), std::sin(rise), -std::cos(rise) * std::sin(turn));
        });
    const float rim = 0.5f * std::cos(belt) + 0.01f, height = 0.5f * std::sin(belt) - 0.01f;
    const int sides = segments(48, detail, 8);
    Soup& rod = parts["rod"];
    rod.lathe({},
              {{0.0f, height + 0.02f},
               {rim, height},
               {rim, height + 0.03f},
               {0.12f, 0.56f},
               {0.04f, 0.66f},
               {0.0f, 0.66f}},
              sides);
    rod.lathe({},
              {{0.0f, -0.6f},
               {0.03f, -0.58f},
               {0.05f, -0.52f},
               {rim, -height - 0.03f},
               {rim, -height},
               {0.0f, -height - 0.01f}},
              sides);
    rod.add(make_rod({0, 0.6f, 0}, {0, 6.0f, 0}, 0.015f), {});
    return parts;
}

Parts make_lone_tree(float detail, std::uint64_t seed) {
    core::Rng rng(core::hash_keys(seed, 0x6f616bull));
    return make_tree({9.0f, 8, segments(44, detail, 1), 0.2f}, rng);
}

}  // namespace mote::tools
