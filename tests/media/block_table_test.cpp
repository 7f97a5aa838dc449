// Lookups through the table of blocks, and in grids too sparse for one.
// clang-format off: the builder does not include what it needs
#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridBuilder.h>
// clang-format on

#include <cstring>

#include "media/nano_grid.h"
#include "tests/support/catch.h"

using namespace mote;

namespace {

/// Two lumps of 12^3 voxels, `apart` voxels from each other along every axis, in a background of 0.25.
std::shared_ptr<const media::VdbGrid> lumps(int apart) {
    nanovdb::GridBuilder<float> builder(0.25f, nanovdb::GridClass::FogVolume);
    auto accessor = builder.getAccessor();
    for (const int from : {-6, apart})
        for (int x = 0; x < 12; ++x)
            for (int y = 0; y < 12; ++y)
                for (int z = 0; z < 12; ++z)
                    accessor.setValue({from + x, from + y, from + z}, 1.0f + float(x + 2 * y + 4 * z));
    const auto handle = builder.getHandle<>();
    auto data = std::make_unique<media::VdbGrid::Data>();
    data->buffer = media::AlignedBuffer(handle.size());
    std::memcpy(data->buffer.data(), handle.data(), handle.size());
    data->grid = media::checked_nano_grid(data->buffer, "<made in code>");
    data->background = 0.25f, data->max_value = 78.0f, data->uniform = false;
    data->lower = media::Voxel(-6), data->upper = media::Voxel(apart + 11);
    return std::make_shared<media::VdbGrid>(std::move(data));
}

}  // namespace

TEST_CASE("lookups are linear within lumps and the background outside, near and far", "[media][vdb]") {
    for (const int apart : {20, 40000}) {
        const auto grid = lumps(apart);
        CHECK(grid->data().table.empty() == (apart > 1000));
        const media::NanoCursor cursor(*grid);
        for (const double from : {-6.0, double(apart)})
            for (double x = 0.0; x <= 11.0; x += 0.6875)
                for (double z = 0.0; z <= 11.0; z += 0.6875) {
                    const core::Vec3d p(x, 11.0 - x, z);
                    REQUIRE(cursor.lookup(from + p) == Approx(1.0 + p.x + 2.0 * p.y + 4.0 * p.z));
                }
        for (const double p : {-1e12, -7.0, 6.5, apart - 1.0, apart + 12.0, 1e12})
            CHECK(cursor.lookup(core::Vec3d(p)) == 0.25f);
        // Half of the way from the last voxel, 78, to the background along one axis.
        CHECK(cursor.lookup(core::Vec3d(apart + 11.5, apart + 11.0, apart + 11.0)) == Approx(39.125));
    }
}
