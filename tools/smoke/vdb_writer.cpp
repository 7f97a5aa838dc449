#include "tools/smoke/vdb_writer.h"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <filesystem>
#include <fstream>

#include "core/objects/error.h"

namespace mote::tools {

namespace {

// OpenVDB's header: magic number (8 bytes), file version, two library versions (4 each), one flag, and then a
// random UUID of 36 characters, which alone would make two runs differ.
constexpr std::streamoff uuid_offset = 21;

/// Replaces the random UUID by one that depends on the rest of the file alone.
void make_reproducible(const std::string& path) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    std::string uuid(36, '\0');
    file.seekg(uuid_offset);
    if (!file.read(uuid.data(), 36) || uuid[8] != '-' || uuid[13] != '-' || uuid[23] != '-') return;
    std::uint64_t h = 0xcbf29ce484222325ull;  // FNV-1a over everything behind the UUID
    char byte = 0;
    while (file.get(byte)) h = (h ^ std::uint8_t(byte)) * 0x100000001b3ull;
    file.clear();
    for (std::size_t i = 0; i < uuid.size(); ++i)
        if (uuid[i] != '-') uuid[i] = "0123456789abcdef"[(h >> (4 * (i % 16))) & 15u];
    file.seekp(uuid_offset);
    file.write(uuid.data(), 36);
}

openvdb::FloatGrid::Ptr make_grid(const GridSize& size, const std::vector<float>& density, float cell,
                                  float cut_off) {
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    const openvdb::CoordBBox box(openvdb::Coord(0), openvdb::Coord(size.x - 1, size.y - 1, size.z - 1));
    const openvdb::tools::Dense<const float, openvdb::tools::LayoutXYZ> dense(box, density.data());
    openvdb::tools::copyFromDense(dense, *grid, cut_off);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setSaveFloatAsHalf(true);
    // Voxel (i, j, k) is a sample at its integer coordinates: the centre of cell (i, j, k).
    auto transform = openvdb::math::Transform::createLinearTransform(double(cell));
    transform->postTranslate(0.5 * double(cell) *
                             openvdb::Vec3d(1.0 - double(size.x), 1.0, 1.0 - double(size.z)));
    grid->setTransform(transform);
    return grid;
}

}  // namespace

VdbSummary write_vdb(const std::string& path, const GridSize& size, const std::vector<float>& density,
                     float cell, float cut_off) {
    openvdb::initialize();
    const openvdb::FloatGrid::Ptr grid = make_grid(size, density, cell, cut_off);
    const std::string temporary = path + ".part";
    std::error_code failed;
    try {
        openvdb::io::File file(temporary);
        file.write({grid});
        file.close();
        make_reproducible(temporary);
    } catch (const openvdb::Exception& e) {
        std::filesystem::remove(temporary, failed);
        throw core::InputError("cannot write '" + path + "': " + e.what());
    }
    std::filesystem::rename(temporary, path, failed);
    if (failed) throw core::InputError("cannot write '" + path + "': " + failed.message());
    return {grid->activeVoxelCount(), std::size_t(std::filesystem::file_size(path))};
}

}  // namespace mote::tools
