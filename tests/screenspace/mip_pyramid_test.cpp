// Pyramids: what must be conserved, what must be bounded, what must be marked.
#include "screenspace/ssbc/mip_pyramid.h"

#include "tests/screenspace/ssbc_room.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

const float angle = 0.44f;

}  // namespace

TEST_CASE("Every level holds the same area and the same power", "[mip_pyramid]") {
    for (const int width : {1, 5, 37, 64}) {
        const TestPicture picture = room(std::max(width, 2));
        const SurfacePyramid surfaces(picture.surfaces.width, picture.surfaces.height,
                                      pixel_patches(picture.surfaces, angle), angle);
        LightPyramid light(surfaces);
        light.fill(surfaces, picture.light);
        double area = 0.0, power = 0.0;
        for (std::size_t i = 0; i < picture.light.size(); ++i)
            area += surfaces.patches()[i].area,
                power += double(surfaces.patches()[i].area * picture.light[i].x);
        CHECK(surfaces.levels().back().size() == 1);
        for (std::size_t l = 0; l < surfaces.levels().size(); ++l) {
            double a = 0.0, p = 0.0;
            for (std::size_t i = 0; i < surfaces.levels()[l].size(); ++i)
                a += surfaces.levels()[l].nodes[i].area, p += double(light.power(int(l), i).x);
            CHECK(a == Approx(area).epsilon(1e-5));
            CHECK(p == Approx(power).epsilon(1e-5));
        }
    }
}

TEST_CASE("Nodes bound the pixels below them", "[mip_pyramid]") {
    const TestPicture picture = room(48);
    const SurfacePyramid surfaces(48, 36, pixel_patches(picture.surfaces, angle), angle);
    for (std::size_t l = 1; l < surfaces.levels().size(); ++l) {
        const auto& level = surfaces.levels()[l];
        for (int y = 0; y < 36; ++y)
            for (int x = 0; x < 48; ++x) {
                const PixelPatch& p = surfaces.patches()[picture.index(x, y)];
                if (p.area == 0.0f) continue;
                const SurfaceNode& node = level.nodes[level.index(x >> l, y >> l)];
                CHECK(node.bounds.contains(p.centre));
                CHECK(glm::length(p.centre - node.position) <= node.radius * 1.0001f);
                const Vec3 n = glm::normalize(node.normal);
                CHECK(std::abs(glm::dot(p.centre - node.position, n)) <= node.thickness + 1e-5f);
            }
    }
}

TEST_CASE("Nodes are marked where they span an edge, and only there", "[mip_pyramid]") {
    const TestPicture picture = room(64);
    const SurfacePyramid surfaces(64, 48, pixel_patches(picture.surfaces, angle), angle);
    for (std::size_t l = 0; l < surfaces.levels().size(); ++l) {
        const auto& level = surfaces.levels()[l];
        std::vector<int> first(level.size(), -1);
        std::vector<bool> mixed(level.size(), false);
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x) {
                const int wall = picture.wall[picture.index(x, y)];
                const std::size_t node = level.index(x >> l, y >> l);
                if (wall < 0) continue;
                if (first[node] >= 0 && first[node] != wall) mixed[node] = true;
                first[node] = wall;
            }
        for (std::size_t i = 0; i < level.size(); ++i) {
            INFO("level " << l << ", node " << i);
            CHECK(bool(level.discontinuity[i]) == mixed[i]);
        }
    }
}

TEST_CASE("Beside a concave edge patches end at the edge, and cover the floor", "[mip_pyramid][ssbc]") {
    // A floor and a wall, seen so that the edge runs along rows of pixels and cuts them at `shift`.
    for (const double shift : {0.02, 0.3, 0.7, 0.98}) {
        const std::vector<Wall> walls = {{{0, 0, 0}, {9, 0, 0}, {0, 0, 9}},
                                         {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}};
        const double pixel = 2.0 * 0.1 / 32.0 * std::sqrt(18.0);
        const Vec3d up = shift * pixel * Vec3d(0, 1, -1) / std::sqrt(2.0);
        const TestPicture picture = picture_of(walls, {Vec3d(0, 3, 3) + up, up, {0, 1, 0}, 0.1, 32, 32});
        const auto patches = pixel_patches(picture.surfaces, angle);
        for (std::size_t i = 0; i < patches.size(); ++i) {
            const Vec3 reach = glm::abs(patches[i].a) + glm::abs(patches[i].b);
            const float height = picture.wall[i] == 0 ? patches[i].centre.z : patches[i].centre.y;
            const float extent = picture.wall[i] == 0 ? reach.z : reach.y;
            CHECK(height - extent > -0.02 * pixel);
            // The row beside the edge begins there: the wall that a pixel shows nearest to the edge has no
            // gap.
            const std::size_t below = i + 32, above = i - 32;
            const bool at_edge = (i >= 32 && picture.wall[above] != picture.wall[i]) ||
                                 (below < patches.size() && picture.wall[below] != picture.wall[i]);
            if (at_edge) CHECK(height - extent < 0.1 * pixel);
        }
    }
}
