// Charts and texels: every surface once, areas as promised, lookups where they belong, budgets kept.
#include "core/objects/error.h"
#include "gathering/atlas/cell_pieces.h"
#include "gathering/atlas/surface_locator.h"
#include "tests/gathering/bundle_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using namespace mote::tests;

namespace {

std::vector<std::shared_ptr<Shape>> shapes_of(const std::string& bsdf, const std::string& type = "rectangle",
                                              const std::string& more = "") {
    static std::vector<std::unique_ptr<Scene>> scenes;
    scenes.push_back(scene_from(R"(<scene version="3.0.0"><shape type=")" + type + R"(">)" + bsdf + more +
                                R"(</shape><emitter type="constant"/><sensor type="perspective"/></scene>)"));
    const auto shapes = scenes.back()->shapes();
    return {shapes.begin(), shapes.end()};
}
const std::string diffuse = R"(<bsdf type="diffuse"/>)";
const std::string twosided = R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)";

/// Message of the InputError that making the atlas throws, or "".
std::string refusal(const SurfaceTriangles& surfaces, std::span<const std::shared_ptr<Shape>> shapes,
                    const AtlasSettings& settings) {
    try {
        SurfaceAtlas atlas(surfaces, shapes, settings);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

double total_area(const SurfaceAtlas& atlas) {
    double sum = 0.0;
    for (const AtlasTexel& t : atlas.texels()) sum += double(t.area);
    return sum;
}

/// A grid of 2 n^2 triangles over the square [0, 1]^2, at heights that `height(x, y)` gives.
template <typename Height>
SurfaceTriangles carpet(int n, const Height& height) {
    TriangleBuilder builder;
    const auto p = [&](int i, int j) {
        const float x = float(i) / float(n), y = float(j) / float(n);
        return Vec3(x, y, height(x, y));
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) builder.quad(p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1));
    return builder.list();
}

}  // namespace

TEST_CASE("a triangle's pieces add up to the triangle", "[atlas]") {
    const std::array<Vec2, 3> triangle{Vec2(0.3f, 0.2f), Vec2(7.6f, 1.9f), Vec2(2.2f, 5.4f)};
    double area = 0.0;
    glm::dvec2 moment(0.0);
    for_each_piece(triangle, 8, 6, [&](std::uint32_t x, std::uint32_t y, double a, const Vec2& c) {
        CHECK((a > 0.0 && a < 1.0 + 1e-6));
        CHECK((c.x >= float(x) - 1e-5f && c.x <= float(x + 1) + 1e-5f && c.y >= float(y) - 1e-5f));
        area += a, moment += a * glm::dvec2(c);
    });
    CHECK(area == Approx(0.5 * (7.3 * 5.2 - 1.9 * 1.7)).epsilon(1e-6));
    CHECK(moment.x / area == Approx((0.3 + 7.6 + 2.2) / 3).epsilon(1e-5));
    CHECK(moment.y / area == Approx((0.2 + 1.9 + 5.4) / 3).epsilon(1e-5));
}

TEST_CASE("a wall is one chart, however many triangles it has, and a box has six", "[atlas]") {
    CHECK(make_charts(carpet(20, [](float, float) { return 0.0f; })).charts.size() == 1);
    CHECK(make_charts(TriangleBuilder().box(Vec3(0), Vec3(1, 2, 3), false).list()).charts.size() == 6);
    // A fold of 60 degrees parts what a fold of 20 degrees does not.
    const auto folded = [](float slope) {
        return carpet(2, [slope](float x, float) { return slope * std::fmax(0.0f, x - 0.5f); });
    };
    CHECK(make_charts(folded(std::tan(0.35f))).charts.size() == 1);
    CHECK(make_charts(folded(std::tan(1.05f))).charts.size() == 2);
}

TEST_CASE("texels hold all of the surface, in areas within a factor of two", "[atlas]") {
    const auto shapes = shapes_of(diffuse);
    const auto check = [&](const SurfaceTriangles& surfaces, float density, double smallest) {
        double area = 0.0;
        for (const auto& c : surfaces.corners)
            area += 0.5 * double(glm::length(glm::cross(c[1] - c[0], c[2] - c[0])));
        const SurfaceAtlas atlas(surfaces, shapes, {.texels_per_metre = density});
        CHECK(total_area(atlas) == Approx(area).epsilon(1e-4));
        for (const AtlasTexel& t : atlas.texels()) {
            const double relative = double(t.area * density * density);
            CHECK(relative < 2.001 / 0.8);  // 1 / 0.8: a tilt within the chart
            CHECK(relative > smallest);
        }
        return atlas.size();
    };
    CHECK(check(TriangleBuilder().quad({0, 0, 0}, {1.37f, 0, 0}, {1.37f, 0.9f, 0}, {0, 0.9f, 0}).list(),
                10.0f, 0.5) == 14 * 9);
    check(TriangleBuilder().triangle({0, 0, 0}, {1, 0, 0}, {0.2f, 0.8f, 0}).list(), 13.0f, 0.35);
    const auto hill = [](float x, float y) { return 0.3f * x * y; };
    check(carpet(30, hill), 12.0f, 0.35);
}

TEST_CASE("sides that neither reflect nor emit have no texels", "[atlas]") {
    const SurfaceTriangles wall = TriangleBuilder().quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}).list();
    const std::string lamp = R"(<emitter type="area"><rgb name="radiance" value="1"/></emitter>)";
    const auto texels = [&](const std::string& bsdf, const std::string& more = "") {
        const SurfaceAtlas atlas(wall, shapes_of(bsdf, "rectangle", more), {.texels_per_metre = 2.0f});
        std::array<int, 2> count{0, 0};
        for (const AtlasTexel& t : atlas.texels()) ++count[std::size_t(t.side)];
        return count;
    };
    CHECK(texels(diffuse) == std::array{4, 0});
    CHECK(texels(twosided) == std::array{4, 4});
    CHECK(texels(R"(<bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>)") == std::array{0, 0});
    CHECK(texels(R"(<bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>)", lamp) ==
          std::array{4, 0});
    CHECK(texels(R"(<bsdf type="conductor"/>)") == std::array{0, 0});  // a mirror: nothing can be evaluated
    CHECK(texels(R"(<bsdf type="roughconductor"/>)") == std::array{4, 0});
    CHECK(texels(R"(<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
        <bsdf type="diffuse"/></bsdf>)") == std::array{0, 4});
}

TEST_CASE("a place's texel lies there, and blends are linear up to the border", "[atlas]") {
    const auto shapes = shapes_of(twosided);
    const SurfaceTriangles hill = carpet(9, [](float x, float y) { return 0.2f * x * (1.0f - y); });
    const SurfaceAtlas atlas(hill, shapes, {.texels_per_metre = 8.0f});
    Rng rng(4);
    for (int i = 0; i < 300; ++i) {
        const auto triangle = rng.next_u32() % std::uint32_t(hill.size());
        Vec2 w = rng.next_vec2();
        if (w.x + w.y > 1.0f) w = 1.0f - w;
        const auto& c = hill.corners[triangle];
        const Vec3 p = (1.0f - w.x - w.y) * c[0] + w.x * c[1] + w.y * c[2];
        const SurfaceSide side = i % 2 == 0 ? SurfaceSide::front : SurfaceSide::back;
        const AtlasTexel& texel = atlas.texels()[atlas.texel(triangle, w.x, w.y, side)];
        CHECK(glm::length(texel.position - p) < 2.0f / 8.0f);
        CHECK(texel.side == side);
        CHECK((texel.normal.z > 0.0f) == (side == SurfaceSide::front));
        const auto blend = atlas.blend(triangle, w.x, w.y, side);
        REQUIRE(blend);
        Vec3 mean(0.0f);
        float weight = 0.0f;
        for (std::size_t k = 0; k < 4; ++k)
            mean += blend->weight[k] * atlas.texels()[blend->texel[k]].position, weight += blend->weight[k];
        CHECK(weight == Approx(1.0f).epsilon(1e-5));
        const bool inside = std::min(p.x, p.y) > 0.13f && std::max(p.x, p.y) < 0.87f;
        if (inside) CHECK(glm::length(Vec2(mean) - Vec2(p)) < 0.6f / 8.0f);
    }
}

TEST_CASE("on a wall blends are linear up to the border", "[atlas]") {
    const auto shapes = shapes_of(diffuse);
    const SurfaceTriangles wall = TriangleBuilder().quad({0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}).list();
    const SurfaceAtlas atlas(wall, shapes, {.texels_per_metre = 5.0f});
    for (const Vec2& w : {Vec2(0, 0), Vec2(0.5f, 0.5f), Vec2(0.001f, 0.4f), Vec2(1, 0), Vec2(0.3f, 0.3f)}) {
        const auto blend = atlas.blend(0, w.x, w.y, SurfaceSide::front);
        REQUIRE(blend);
        Vec3 mean(0.0f);
        for (std::size_t k = 0; k < 4; ++k)
            mean += blend->weight[k] * atlas.texels()[blend->texel[k]].position;
        const auto& c = wall.corners[0];
        CHECK(glm::length(mean - ((1.0f - w.x - w.y) * c[0] + w.x * c[1] + w.y * c[2])) < 1e-5f);
    }
    CHECK_FALSE(atlas.blend(0, 0.3f, 0.3f, SurfaceSide::back));
}

TEST_CASE("hits are found again in the list of triangles", "[atlas]") {
    const auto scene = scene_from(R"(<scene version="3.0.0"><shape type="sphere"/>
        <shape type="cube"><transform name="to_world"><translate x="3"/></transform></shape>
        <emitter type="constant"/><sensor type="perspective"/></scene>)");
    const SurfaceTriangles surfaces = surface_triangles(scene->shapes());
    const SurfaceLocator locator(surfaces);
    Rng rng(8);
    for (int i = 0; i < 100; ++i) {
        const Vec3 target(i % 2 == 0 ? 0.0f : 3.0f, 0.8f * (rng.next_float() - 0.5f),
                          0.8f * (rng.next_float() - 0.5f));
        const Vec3 origin = target + Vec3(0.3f, 0.2f, i % 4 < 2 ? 5.0f : -5.0f);
        const auto hit = scene->first_hit({origin, glm::normalize(target - origin)});
        REQUIRE(hit);
        const auto place = locator.find(*hit);
        REQUIRE(place);
        const auto& c = surfaces.corners[place->triangle];
        const Vec3 p = (1.0f - place->u - place->v) * c[0] + place->u * c[1] + place->v * c[2];
        CHECK(glm::length(p - hit->position) < 4e-3f);  // twice the chord error of a tessellated sphere
        CHECK(std::min({place->u, place->v, 1.0f - place->u - place->v}) > -0.1f);
    }
}

TEST_CASE("a budget is met, or refused with the density that fits", "[atlas][refusal]") {
    const auto shapes = shapes_of(twosided);
    const SurfaceTriangles wall = TriangleBuilder().quad({0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}).list();
    const SurfaceAtlas atlas(wall, shapes, {.texel_budget = 5000});
    CHECK((atlas.size() <= 5000 && atlas.size() > 4500));
    const std::string dense = refusal(wall, shapes, {.texels_per_metre = 100.0f, .texel_budget = 5000});
    INFO(dense);
    CHECK(dense.find("texel_budget is 5000: 20") != std::string::npos);
    // Triangles that hang together and are smaller than a texel share one; a heap of loose ones is refused.
    const SurfaceTriangles fine =
        carpet(150, [](float x, float y) { return 0.02f * std::sin(9.0f * x + y); });
    const SurfaceAtlas coarse(fine, shapes, {.texel_budget = 200});
    CHECK(coarse.size() <= 200);
    CHECK(total_area(coarse) == Approx(2.0).epsilon(0.03));
    TriangleBuilder loose;
    for (int i = 0; i < 300; ++i)
        loose.triangle({float(i), 0, 0}, {float(i) + 0.1f, 0, 0}, {float(i), 0.1f, 0});
    const std::string many = refusal(loose.list(), shapes, {.texel_budget = 500});
    INFO(many);
    CHECK(many.find("needs 600 texels at least") != std::string::npos);
}

TEST_CASE("triangles without area, and none at all, make no texels", "[atlas][degenerate]") {
    const auto shapes = shapes_of(diffuse);
    const SurfaceTriangles flat = TriangleBuilder().triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0}).list();
    const SurfaceAtlas atlas(flat, shapes, {});
    CHECK(atlas.size() == 0);
    CHECK(atlas.texel(0, 0.3f, 0.3f, SurfaceSide::front) == SurfaceAtlas::none);
    CHECK(SurfaceAtlas(SurfaceTriangles{}, shapes, {}).size() == 0);
    // A needle is one texel, whatever its length is to its width.
    const SurfaceTriangles needle = TriangleBuilder().triangle({0, 0, 0}, {1, 0, 0}, {1, 1e-6f, 0}).list();
    const SurfaceAtlas thin(needle, shapes, {.texels_per_metre = 4.0f});
    CHECK((thin.size() >= 1 && thin.size() <= 4));
}
