// Filtered lookups in directional maps: continuous over every edge, and the mip level of a footprint.

#include <array>

#include "core/math/random.h"
#include "core/math/warp.h"
#include "lights/directional_maps/octahedral_map.h"
#include "tests/support/catch.h"
#include "tools/directional_maps/directional_map.h"

using namespace mote::core;
using namespace mote::lights;
using namespace mote::tools;

namespace {

/// A smooth function, turned and mirrored in all 48 ways that map the axes to axes: no edge is flattered.
constexpr int turns = 48;
double smooth(const Vec3& d, int turn) {
    constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const auto part = [&](int k) { return double(d[orders[turn / 8][k]]) * (turn >> k & 1 ? -1.0 : 1.0); };
    const double x = part(0), y = part(1), z = part(2);
    return 0.6 * x - 0.4 * y + 0.5 * z + 0.8 * x * y + 0.5 * y * z + std::sin(2.0 * x + y - z);
}
using Turned = std::array<double, turns>;
Turned all_turns(const Vec3& d) {
    Turned result{};
    for (int k = 0; k < turns; ++k) result[std::size_t(k)] = smooth(d, k);
    return result;
}

/// The largest errors where a lookup reads beyond an edge of its face, and elsewhere.
struct Errors {
    double inside = 0.0, border = 0.0;
};

/// `footprint(map, point, direction)` gives the taps.
template <class Footprint>
Errors filter_errors(const DirectionalMap& map, const Footprint& footprint) {
    std::vector<Turned> values;
    for (int t = 0; t < map.texels(); ++t) values.push_back(all_turns(map.direction(t)));
    Errors worst;
    Rng rng(3);
    for (int i = 0; i < 30000; ++i) {
        Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
        if (i % 3 == 0) d[i / 3 % 3] *= 0.02f;  // more of them beside the planes where octants meet
        if (map.domain() < 7.0) d.z = std::fabs(d.z);
        d = glm::normalize(d);
        const MapPoint p = map.project(d);
        const Vec2 texels = p.uv * Vec2(float(map.width()), float(map.height()));
        const bool border = texels.x < 0.5f || texels.y < 0.5f || texels.x > float(map.width()) - 0.5f ||
                            texels.y > float(map.height()) - 0.5f;
        const FilterTaps taps = footprint(map, p, d);
        Turned sum = all_turns(d);
        for (std::size_t k = 0; k < std::size_t(taps.count); ++k)
            for (std::size_t f = 0; f < turns; ++f)
                sum[f] -= double(taps.weight[k]) * values[std::size_t(taps.texel[k])][f];
        for (const double error : sum) {
            double& slot = border ? worst.border : worst.inside;
            slot = std::max(slot, std::fabs(error));
        }
    }
    return worst;
}
Errors filter_errors(MapKind kind, int size) {
    return filter_errors(*make_directional_map(kind, size),
                         [](const DirectionalMap& m, const MapPoint&, const Vec3& d) { return m.taps(d); });
}

/// The planted error: faces end at the centres of their outer texels.
FilterTaps without_border(const DirectionalMap& map, const MapPoint& p, const Vec3&) {
    const TexelCell cell(p.uv, map.width(), map.height());
    const auto weights = cell.weights();
    FilterTaps taps;
    for (int k = 0; k < 4; ++k) {
        const int i = std::clamp(cell.i + (k & 1), 0, map.width() - 1);
        const int j = std::clamp(cell.j + (k >> 1), 0, map.height() - 1);
        taps.add((p.face * map.height() + j) * map.width() + i, weights[std::size_t(k)]);
    }
    return taps;
}

/// Largest border error over largest inner error that passes: both are maxima over samples.
constexpr double tolerated = 1.15;

}  // namespace

TEST_CASE("Bilinear lookups are no worse over a border than inside", "[directional_map][filter]") {
    for (const MapKindName& k : map_kinds()) {
        if (k.kind == MapKind::hemi_octahedral) continue;  // it ends at the horizon: next test
        const Errors e = filter_errors(k.kind, 32);
        INFO(k.name << ": inside " << e.inside << ", border " << e.border);
        CHECK(e.border <= tolerated * e.inside);
        if (k.kind == MapKind::sphere)
            continue;  // so bad at its rim, inside as well, that no border would show
        const Errors planted = filter_errors(*make_directional_map(k.kind, 32), without_border);
        INFO("without the border: " << planted.border);
        CHECK(planted.border > 1.3 * e.inside);
    }
}

TEST_CASE("The error of bilinear lookups falls with the size as it must", "[directional_map][filter]") {
    // Quadratic where directions vary smoothly with texels; linear at the creases of the octahedron and where
    // the hemisphere ends; with the square root at the rim of a sphere map.
    for (const MapKindName& k : map_kinds()) {
        const Errors coarse = filter_errors(k.kind, 16), fine = filter_errors(k.kind, 64);
        const bool smooth_map =
            k.kind == MapKind::cube || k.kind == MapKind::latitude_longitude || k.kind == MapKind::paraboloid;
        const double factor = smooth_map ? 1.0 / 16.0 : k.kind == MapKind::sphere ? 0.5 : 0.25;
        INFO(k.name << ": inside " << coarse.inside << " to " << fine.inside << ", border " << coarse.border
                    << " to " << fine.border);
        CHECK(fine.inside < 1.3 * factor * coarse.inside);
        CHECK(fine.border < 1.3 * factor * coarse.border);
    }
}

TEST_CASE("Weights of a lookup add up to one, in every corner and in one texel",
          "[directional_map][filter]") {
    Rng rng(5);
    for (const MapKindName& k : map_kinds())
        for (const int size : {1, 2, 3}) {
            const auto map = make_directional_map(k.kind, size);
            double worst = 0.0;
            for (int i = 0; i < 3000; ++i) {
                Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
                if (i % 2 == 0) d = glm::sign(d) + 0.01f * d;
                const std::vector<double> ones(std::size_t(map->texels()), 1.0);
                worst = std::max(worst, std::fabs(bilinear<double>(*map, ones, d) - 1.0));
            }
            INFO(k.name << " " << size << ": " << worst);
            CHECK(worst < 1e-5);
        }
}

TEST_CASE("The structs' footprints are the interface's", "[directional_map][filter]") {
    const auto agree = [](const auto& map, MapKind kind) {
        const auto other = make_directional_map(kind, map.size);
        std::vector<float> values;
        for (int t = 0; t < map.texels(); ++t) values.push_back(float(t * t % 17));
        Rng rng(4);
        double worst = 0.0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
            const BilinearFootprint f = map.footprint(d);
            float sum = 0.0f;
            for (std::size_t k = 0; k < 4; ++k) sum += f.weight[k] * values[std::size_t(f.texel[k])];
            worst = std::max(worst, std::fabs(double(sum) - bilinear<float>(*other, values, d)));
        }
        return worst;
    };
    for (const int size : {1, 2, 5, 8}) {
        CHECK(agree(OctahedralMap{size}, MapKind::octahedral) < 1e-5);
        CHECK(agree(HemiOctahedralMap{size}, MapKind::hemi_octahedral) < 1e-5);
    }
}

TEST_CASE("NaN reads texels of the map and stays NaN", "[directional_map][filter]") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Vec3& d : {Vec3(nan), Vec3(nan, 0, 1), Vec3(0, 0, nan)}) {
        const BilinearFootprint f = OctahedralMap{4}.footprint(d), h = HemiOctahedralMap{4}.footprint(d);
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK((f.texel[k] >= 0 && f.texel[k] < 16 && h.texel[k] >= 0 && h.texel[k] < 16));
            CHECK((std::isnan(f.weight[k]) && std::isnan(h.weight[k])));
        }
        for (const MapKindName& kind : map_kinds()) {
            const auto map = make_directional_map(kind.kind, 4);
            const FilterTaps taps = map->taps(d);
            for (int k = 0; k < taps.count; ++k) CHECK((taps.texel[k] >= 0 && taps.texel[k] < map->texels()));
            const std::vector<double> ones(std::size_t(map->texels()), 1.0);
            INFO(kind.name);
            CHECK(std::isnan(bilinear<double>(*map, ones, d)));
        }
    }
}

TEST_CASE("The mip level of a footprint, also over a cut and over the horizon", "[directional_map][filter]") {
    const OctahedralMap map{64};
    const auto at = [&](int i, int j) { return map.direction(j * 64 + i); };
    CHECK(map.mip_level(at(35, 36), at(39, 36), at(35, 38)) == Approx(2.0f).margin(1e-4));
    const HemiOctahedralMap half{64};
    CHECK(half.mip_level(half.direction(100), half.direction(102), half.direction(100 + 8 * 64)) ==
          Approx(3.0f).margin(1e-4));

    // Over the cut x = 0 below the horizon: as over x = 0 above it, where nothing is cut.
    const Vec3 a(0.01f, 0.5f, 0.8f), a_x(-0.01f, 0.5f, 0.8f), a_y(0.01f, 0.52f, 0.8f);
    const Vec3 down(1, 1, -1);
    const float above = map.mip_level(a, a_x, a_y);
    CHECK(map.mip_level(a * down, a_x * down, a_y * down) == Approx(above).margin(1e-4));
    // The plain difference of coordinates spans half of the map.
    CHECK(mip_level_of(64.0f * (map.uv(a_x * down) - map.uv(a * down)), {}) > above + 3.0f);

    // Over the horizon: the minimum with the mirrored footprint, as Sec. 7.2.2 has it for all footprints, is
    // a footprint of no size. The true one is that of the same directions tilted up until all lie above.
    const Vec3 b(0.5f, 0.6f, 0.01f), b_x(0.5f, 0.6f, -0.01f), b_y(0.505f, 0.595f, 0.01f);
    const Vec3 tilt(0, 0, 0.02f);
    const float tilted = map.mip_level(b + tilt, b_x + tilt, b_y + tilt);
    CHECK(map.mip_level(b, b_x, b_y) == Approx(tilted).margin(0.1));
    CHECK(map.uv(b_x * down) == map.uv(b));
}
