// Writing the leaves and tiles of a VDB grid into a box of voxels.
#include "media/vdb_to_vol.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "media/nano_grid.h"

namespace mote::media {

namespace {

/// Boxes of voxels, both ends included.
struct Box {
    Voxel lower, upper;
};

class Filler {
  public:
    Filler(VolFile& file, const Box& box) : file_(file), box_(box) {}

    /// Sets the part of [first, last] that lies in the box; value(voxel) is what stands there.
    template <typename Value>
    void fill(const Voxel& first, const Voxel& last, const Value& value) {
        const Voxel a = glm::max(first, box_.lower), b = glm::min(last, box_.upper);
        for (std::int64_t z = a.z; z <= b.z; ++z)
            for (std::int64_t y = a.y; y <= b.y; ++y)
                for (std::int64_t x = a.x; x <= b.x; ++x) file_.values[index({x, y, z})] = value({x, y, z});
    }

  private:
    std::size_t index(const Voxel& v) const {
        const Voxel p = v - box_.lower, n(file_.resolution);
        return std::size_t((p.z * n.y + p.y) * n.x + p.x);
    }
    VolFile& file_;
    Box box_;
};

void refuse_large(const VdbGrid& grid, const Voxel& n, std::uint64_t max_bytes) {
    const double bytes = 4.0 * double(n.x) * double(n.y) * double(n.z);
    if (bytes > double(max_bytes) || n.x > (1 << 16) || n.y > (1 << 16) || n.z > (1 << 16))
        throw core::InputError(fmt::format(
            "grid '{}' as a dense .vol has {} x {} x {} voxels, {:.3g} MB; the limit is {:.3g} MB",
            grid.name(), n.x, n.y, n.z, bytes * 1e-6, double(max_bytes) * 1e-6));
}

}  // namespace

VolFile dense_twin(const VdbGrid& grid, std::uint64_t max_bytes) {
    const Box box =
        grid.uniform() ? Box{Voxel(0), Voxel(0)} : Box{grid.lower() - Voxel(1), grid.upper() + Voxel(1)};
    const Voxel n = box.upper - box.lower + Voxel(1);
    refuse_large(grid, n, max_bytes);
    const Voxel reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    if (std::max({reach.x, reach.y, reach.z}) >= (1 << 22))  // half a voxel would be lost in the bounds
        throw core::InputError(
            fmt::format("grid '{}' reaches beyond voxel 4e6: a .vol cannot hold its bounds", grid.name()));
    VolFile file;
    file.resolution = glm::ivec3(n);
    file.bounds = {core::Vec3(box.lower) - 0.5f, core::Vec3(box.upper) + 0.5f};
    file.values.assign(std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z), grid.background());
    Filler filler(file, box);
    for_each_node(
        *grid.data().grid,
        [&](const Voxel& origin, const float* values) {
            filler.fill(origin, origin + Voxel(7), [&](const Voxel& v) {
                const Voxel local = v - origin;
                return values[(local.x << 6) | (local.y << 3) | local.z];
            });
        },
        [&](const Voxel& origin, std::int64_t edge, float value) {
            filler.fill(origin, origin + Voxel(edge - 1), [&](const Voxel&) { return value; });
        });
    return file;
}

}  // namespace mote::media
