// mote_test_grid_writer OUT.vdb KIND [16 numbers]: small OpenVDB files for the tests, good and bad.
// The numbers are the index-to-world matrix, column by column.
#include <openvdb/openvdb.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "tests/media/tools/test_density.h"

namespace {

using openvdb::Coord;
using Grids = openvdb::GridPtrVec;

openvdb::FloatGrid::Ptr fog(float background = 0.0f) {
    auto grid = openvdb::FloatGrid::create(background);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setName("density");
    return grid;
}

template <typename GridType>
typename GridType::Ptr lump(double factor) {
    auto grid = GridType::create();
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setName("density");
    auto accessor = grid->getAccessor();
    for (int x = 0; x < mote::tests::test_grid_size; ++x)
        for (int y = 0; y < mote::tests::test_grid_size; ++y)
            for (int z = 0; z < mote::tests::test_grid_size; ++z)
                if (const float v = mote::tests::test_density(x, y, z); v > 0.0f)
                    accessor.setValue(Coord(x, y, z), typename GridType::ValueType(v * factor));
    return grid;
}

openvdb::FloatGrid::Ptr lump_with(float odd_value) {
    auto grid = lump<openvdb::FloatGrid>(1.0);
    grid->getAccessor().setValue(Coord(5, 6, 7), odd_value);
    return grid;
}

openvdb::GridBase::Ptr half_lump() {
    auto grid = lump<openvdb::FloatGrid>(1.0);
    grid->setSaveFloatAsHalf(true);
    return grid;
}

/// 40^3 voxels of 0.75, of which OpenVDB makes tiles where it can.
openvdb::GridBase::Ptr tiles() {
    auto grid = fog();
    grid->fill(openvdb::CoordBBox(Coord(-4), Coord(35)), 0.75f);
    return grid;
}

openvdb::GridBase::Ptr single_voxel() {
    auto grid = fog();
    grid->getAccessor().setValue(Coord(-3, 2, 1000), 2.0f);
    return grid;
}

openvdb::GridBase::Ptr step_of_a_million() {
    auto grid = fog();
    grid->fill(openvdb::CoordBBox(Coord(0), Coord(23)), 1.0f);
    grid->getAccessor().setValue(Coord(12, 12, 12), 1e6f);
    return grid;
}

/// Density 1 in the whole box from -4 to 35.
openvdb::GridBase::Ptr constant() {
    auto grid = fog();
    grid->fill(openvdb::CoordBBox(Coord(-4), Coord(35)), 1.0f);
    return grid;
}

openvdb::GridBase::Ptr with_background() {
    auto grid = lump<openvdb::FloatGrid>(1.0);
    auto raised = fog(0.25f);
    for (auto it = grid->cbeginValueOn(); it; ++it) raised->getAccessor().setValue(it.getCoord(), *it);
    return raised;
}

openvdb::GridBase::Ptr level_set() {
    auto grid = lump<openvdb::FloatGrid>(1.0);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

openvdb::GridBase::Ptr vectors() {
    auto grid = openvdb::Vec3SGrid::create();
    grid->setName("density");
    grid->getAccessor().setValue(Coord(1), openvdb::Vec3s(1, 2, 3));
    return grid;
}

openvdb::GridBase::Ptr frustum() {
    auto grid = lump<openvdb::FloatGrid>(1.0);
    const openvdb::math::NonlinearFrustumMap::Ptr map(
        new openvdb::math::NonlinearFrustumMap(openvdb::BBoxd({0, 0, 0}, {24, 24, 24}), 0.5, 2.0));
    grid->setTransform(std::make_shared<openvdb::math::Transform>(map));
    return grid;
}

openvdb::GridBase::Ptr named(openvdb::GridBase::Ptr grid, const std::string& name) {
    grid->setName(name);
    return grid;
}

using Maker = std::function<Grids()>;
const std::map<std::string, Maker> makers = {
    {"lump", [] { return Grids{lump<openvdb::FloatGrid>(1.0)}; }},
    {"half", [] { return Grids{half_lump()}; }},
    {"double", [] { return Grids{lump<openvdb::DoubleGrid>(1.0)}; }},
    {"int32", [] { return Grids{lump<openvdb::Int32Grid>(100.0)}; }},
    {"nan", [] { return Grids{lump_with(std::nanf(""))}; }},
    {"infinite", [] { return Grids{lump_with(INFINITY)}; }},
    {"negative", [] { return Grids{lump_with(-0.5f)}; }},
    {"tiles", [] { return Grids{tiles()}; }},
    {"single", [] { return Grids{single_voxel()}; }},
    {"step", [] { return Grids{step_of_a_million()}; }},
    {"constant", [] { return Grids{constant()}; }},
    {"background", [] { return Grids{with_background()}; }},
    {"negative_background", [] { return Grids{fog(-1.0f)}; }},
    {"empty", [] { return Grids{fog()}; }},
    {"none", [] { return Grids{}; }},
    {"level_set", [] { return Grids{level_set()}; }},
    {"vectors", [] { return Grids{vectors()}; }},
    {"frustum", [] { return Grids{frustum()}; }},
    {"three",
     [] {
         return Grids{lump<openvdb::FloatGrid>(1.0), lump<openvdb::FloatGrid>(2.0),
                      named(half_lump(), "heat")};
     }},
    {"odd_name", [] { return Grids{named(half_lump(), "line\nbreak\x1b[31m\xff")}; }},
};

}  // namespace

int main(int argc, char* argv[]) {
    if (argc != 3 && argc != 19) return 2;
    openvdb::initialize();
    const auto maker = makers.find(argv[2]);
    if (maker == makers.end()) {
        std::cerr << "unknown kind " << argv[2] << "\n";
        return 2;
    }
    Grids grids = maker->second();
    if (argc == 19) {
        openvdb::Mat4d m;  // OpenVDB multiplies row vectors: its rows are our columns
        for (int i = 0; i < 16; ++i) m(i / 4, i % 4) = std::strtod(argv[3 + i], nullptr);
        for (auto& grid : grids) grid->setTransform(openvdb::math::Transform::createLinearTransform(m));
    }
    openvdb::io::File(argv[1]).write(grids);
    return 0;
}
