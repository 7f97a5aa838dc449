// Upsampling from lattices whose first column is not their first row, and of light that changes along one
// axis.
#include "screenspace/upsampling/upsampling.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::screenspace;

TEST_CASE("a lattice begins at its own column and row", "[screenspace][upsampling][directions]") {
    constexpr int width = 23, height = 14;
    std::vector<UpsamplingPoint> points;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            UpsamplingPoint& p = points.emplace_back();
            p.position = {0.1f * float(x), 0.1f * float(y), 3.0f};
            p.normal = p.shading_normal = {0, 0, -1};
            p.distance = 3.0f, p.footprint = 0.1f, p.modulation = Rgb(1.0f);
        }
    const auto truth = [](int x, int y) { return Rgb(1.0f + float(x), 2.0f + 3.0f * float(y), 1.0f); };
    for (const ShadedLattice lattice :
         {ShadedLattice{4, 3, 0}, ShadedLattice{4, 1, 2}, ShadedLattice{3, 0, 2}}) {
        const Upsampling upsampling(width, height, lattice, LayerKind::surface, points);
        CHECK(upsampling.again().empty());
        std::vector<Rgb> light(points.size(), Rgb(-1e3f));  // wrong where nothing sets it
        int shaded = 0;
        for (int y = lattice.row; y < height; y += lattice.spacing)
            for (int x = lattice.column; x < width; x += lattice.spacing) {
                CHECK(lattice.holds(x, y));
                light[std::size_t(y * width + x)] = truth(x, y), ++shaded;
            }
        int held = 0;
        for (int i = 0; i < width * height; ++i) held += lattice.holds(i % width, i / width);
        CHECK(held == shaded);
        upsampling.fill(light);
        float worst = 0.0f;  // within the outermost points, where light that is linear stays
        for (int y = lattice.row;
             y <= lattice.row + (height - 1 - lattice.row) / lattice.spacing * lattice.spacing; ++y)
            for (int x = lattice.column;
                 x <= lattice.column + (width - 1 - lattice.column) / lattice.spacing * lattice.spacing; ++x)
                worst = std::max(worst, glm::length(light[std::size_t(y * width + x)] - truth(x, y)));
        CHECK(worst < 1e-3f);
    }
}
