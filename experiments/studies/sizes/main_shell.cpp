// A cloud of any number of voxels that is mostly empty: a shell of fog around a sphere, in ripples.
//
//   mote_study_shell OUT.vdb RADIUS     RADIUS in voxels; the shell is 12 voxels thick, in a box of edge 2
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/ValueTransformer.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int argc, char* argv[]) {
    const double radius = argc == 3 ? std::atof(argv[2]) : 0.0;
    if (!(radius >= 16.0 && radius <= 4096.0)) {
        std::fprintf(stderr, "Usage: mote_study_shell OUT.vdb RADIUS (16 to 4096 voxels)\n");
        return 2;
    }
    openvdb::initialize();
    constexpr double depth = 6.0;  // on either side of the sphere, in voxels
    const double voxel = 1.0 / (radius + depth + 2.0);
    const auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
        float(radius * voxel), openvdb::Vec3f(0.0f), float(voxel), float(depth));
    const auto density = [&](const openvdb::FloatGrid::ValueOnIter& at) {
        const openvdb::Vec3d p = grid->transform().indexToWorld(at.getCoord());
        const double ripples = std::sin(40.0 * p.x()) * std::sin(40.0 * p.y()) * std::sin(40.0 * p.z());
        const double within = 1.0 - std::fabs(double(*at)) / (depth * voxel);
        at.setValue(float(std::fmax(0.0, within) * (0.55 + 0.45 * ripples)));
    };
    openvdb::tools::foreach (grid->beginValueOn(), density);
    openvdb::tools::changeBackground(grid->tree(), 0.0f);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setSaveFloatAsHalf(true);
    openvdb::io::File file(argv[1]);
    file.write({grid});
    file.close();
    const openvdb::Coord size = grid->evalActiveVoxelDim();
    std::printf("%d %d %d %llu\n", size.x(), size.y(), size.z(),
                static_cast<unsigned long long>(grid->activeVoxelCount()));
    return 0;
}
