// mote_directional_maps: how directional maps spread their texels over directions, as CSV (figures and checks
// of Engelhardt 2013, Chs. 5 and 7).
//
// One line for each texel: where it is, its direction, its solid angle, the density of texels relative to an
// even one, and the largest and smallest distance between neighbouring texels relative to the even one: the
// singular values of the map's derivative (Snyder & Mitchell 2001). With --lookup, directions come from
// stdin, three numbers each, and the line of the texel that sees them goes out. Exit codes as the mote
// command's: 0, 1 (the input is at fault), 2 (usage), 3 (ours).

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "core/objects/error.h"
#include "tools/directional_maps/directional_map.h"

namespace {

using namespace mote;
using namespace mote::tools;
using core::Vec3;

struct Options {
    std::string kind = "octahedral";
    int size = 64;
    float up = 0.0f;
    bool lookup = false, list = false;
};

struct Spacing {
    double widest, narrowest;
};

/// Distances on the sphere for a step of one texel, from steps of an eighth of it.
Spacing spacing(const DirectionalMap& map, int texel) {
    constexpr float part = 0.125f;
    const MapPoint p = map.project(map.direction(texel));
    const auto step = [&](const core::Vec2& d) {
        const Vec3 ahead = map.unproject({p.face, p.uv + d}), behind = map.unproject({p.face, p.uv - d});
        return core::Vec3d(ahead - behind) / double(part);
    };
    const core::Vec3d a = step({0.5f * part / float(map.width()), 0.0f});
    const core::Vec3d b = step({0.0f, 0.5f * part / float(map.height())});
    const double sum = glm::dot(a, a) + glm::dot(b, b), area = glm::length(glm::cross(a, b));
    // Singular values s and t: s^2 + t^2 = sum, s t = area.
    const double plus = std::sqrt(sum + 2.0 * area), minus = std::sqrt(std::max(sum - 2.0 * area, 0.0));
    const double even = std::sqrt(map.domain() / (map.used_fraction() * map.texels()));
    return {0.5 * (plus + minus) / even, 0.5 * (plus - minus) / even};
}

void print_texel(const DirectionalMap& map, int texel) {
    const int row = texel / map.width();
    const Vec3 d = map.direction(texel);
    const Spacing s = spacing(map, texel);
    std::printf("%d,%d,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", row / map.height(), texel % map.width(),
                row % map.height(), double(d.x), double(d.y), double(d.z), map.used_fraction(texel),
                map.solid_angle(texel), map.sampling_ratio(texel), s.widest, s.narrowest);
}

void look_up(const DirectionalMap& map) {
    Vec3 d;
    while (std::cin >> d.x >> d.y >> d.z) {
        if (!core::is_finite(d) || d == Vec3(0.0f))
            throw core::InputError("stdin: a direction that is zero or not finite");
        print_texel(map, map.texel(d));
    }
    if (!std::cin.eof()) throw core::InputError("stdin: not a number");
}

void run(const Options& o) {
    if (o.list) {
        for (const MapKindName& k : map_kinds()) std::cout << k.name << "\n";
        return;
    }
    const MapKind kind = parse_map_kind(o.kind);
    if (o.up != 0.0f && kind != MapKind::octahedral_perspective)
        throw core::InputError("--up is for the kind octahedral_perspective");
    const auto map =
        o.up == 0.0f ? make_directional_map(kind, o.size) : make_perspective_octahedral_map(o.size, o.up);
    std::puts("face,column,row,x,y,z,used_share,solid_angle,sampling_ratio,widest_spacing,narrowest_spacing");
    if (o.lookup) return look_up(*map);
    for (int t = 0; t < map->texels(); ++t) print_texel(*map, t);
}

}  // namespace

int main(int argc, char* argv[]) {
    CLI::App app("mote_directional_maps: the texels of maps over directions, as CSV");
    Options o;
    app.add_option("--kind", o.kind, "see --list")->capture_default_str();
    app.add_option("--size", o.size, "texels along the shorter edge of a face")->capture_default_str();
    app.add_option("--up", o.up,
                   "octahedral_perspective: cameras along (1, 1, UP) instead of (1, 1, sqrt 2)");
    app.add_flag("--lookup", o.lookup, "the texels of the directions on stdin, in their order");
    app.add_flag("--list", o.list, "the kinds of maps");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    try {
        run(o);
        return 0;
    } catch (const core::InputError& e) {
        std::cerr << "mote_directional_maps: " << e.what() << "\n";
        return 1;
    } catch (const std::exception& e) {
        std::cerr << "mote_directional_maps: internal error: " << e.what() << "\n";
        return 3;
    }
}
