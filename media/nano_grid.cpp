// Checking a NanoVDB buffer before anything follows its offsets, and the bounds of its values.
#include "media/nano_grid.h"

#include "core/objects/error.h"

namespace mote::media {

namespace {

class StructureCheck {
  public:
    StructureCheck(const AlignedBuffer& buffer, const std::string& path)
        : begin_(buffer.data()), size_(buffer.size()), path_(path) {}

    const nanovdb::FloatGrid* run() {
        require(size_ >= sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<3>) + sizeof(Root));
        const auto* data = reinterpret_cast<const nanovdb::GridData*>(begin_);
        require(data->mMagic == NANOVDB_MAGIC_NUMBER && data->mGridSize == size_ &&
                data->mVersion.getMajor() == NANOVDB_MAJOR_VERSION_NUMBER &&
                data->mGridType == nanovdb::GridType::Float && data->mGridCount == 1);
        const auto* grid = reinterpret_cast<const nanovdb::FloatGrid*>(begin_);
        const auto* tree = reinterpret_cast<const nanovdb::TreeData<3>*>(begin_ + sizeof(nanovdb::GridData));
        require(reinterpret_cast<const std::byte*>(&grid->tree()) ==
                reinterpret_cast<const std::byte*>(tree));
        const auto* root = reinterpret_cast<const Root*>(inside(
            reinterpret_cast<const std::byte*>(tree), std::int64_t(tree->mNodeOffset[3]), sizeof(Root)));
        const std::uint64_t table = std::uint64_t(root->mTableSize) * sizeof(Root::Tile);
        inside(reinterpret_cast<const std::byte*>(root), sizeof(Root), table);
        for (std::uint32_t i = 0; i < root->mTableSize; ++i)
            if (const auto* tile = root->tile(i); tile->isChild())
                check<nanovdb::NanoUpper<float>>(reinterpret_cast<const std::byte*>(root), tile->child);
        return grid;
    }

  private:
    using Root = nanovdb::NanoRoot<float>::DataType;

    void require(bool good) const {
        if (!good) throw core::InputError("the reader handed back a malformed grid", {path_, 0});
    }
    /// `base + offset`, when `bytes` from there lie in the buffer, aligned.
    const std::byte* inside(const std::byte* base, std::int64_t offset, std::uint64_t bytes) const {
        const std::int64_t start = (base - begin_) + std::clamp<std::int64_t>(offset, -limit, limit);
        require(start >= 0 && start % 32 == 0 && bytes <= size_ && std::uint64_t(start) <= size_ - bytes);
        return begin_ + start;
    }
    template <typename Node>
    void check(const std::byte* parent, std::int64_t offset) {
        const std::byte* at = inside(parent, offset, sizeof(Node));
        require(++nodes_ <= size_ / sizeof(nanovdb::NanoLeaf<float>));  // no node is shared
        if constexpr (Node::LEVEL > 0) {
            const auto* data = reinterpret_cast<const typename Node::DataType*>(at);
            for (std::uint32_t n = 0; n < (1u << (3 * Node::LOG2DIM)); ++n)
                if (data->mChildMask.isOn(n)) check<typename Node::ChildNodeType>(at, data->mTable[n].child);
        }
    }

    static constexpr std::int64_t limit = std::int64_t(1) << 60;
    const std::byte* begin_;
    std::uint64_t size_;
    std::uint64_t nodes_ = 0;
    const std::string& path_;
};

}  // namespace

const nanovdb::FloatGrid* checked_nano_grid(const AlignedBuffer& buffer, const std::string& path) {
    return StructureCheck(buffer, path).run();
}

BlockTable::BlockTable(const nanovdb::FloatGrid& grid, const Voxel& lower, const Voxel& upper) {
    // Positions from a voxel below the first to one above the last differ from the background; a little more,
    // so that clamping to the table changes nothing.
    const auto block_of = [](const Voxel& v) { return Voxel(v.x >> 3, v.y >> 3, v.z >> 3); };
    const Voxel first = block_of(lower - Voxel(2)), last = block_of(upper + Voxel(2));
    const glm::dvec3 size = glm::dvec3(last - first) + 1.0;
    constexpr double always = double(1 << 21);  // 16 MB
    const double leaves = double(grid.tree().nodeCount(0));
    if (size.x * size.y * size.z > std::max(always, 8.0 * leaves)) return;
    origin_ = 8.0 * core::Vec3d(first), last_ = 8.0 * size - 2.0;
    const Voxel count = last - first + Voxel(1);
    stride_y_ = std::int32_t(count.z), stride_x_ = std::int32_t(count.y * count.z);
    blocks_.assign(std::size_t(count.x * count.y * count.z), uniform(grid.tree().background()));
    for_each_node(
        grid,
        [&](const Voxel& origin, const float* values) {
            const Voxel b = block_of(origin) - first;
            if (glm::all(glm::greaterThanEqual(b, Voxel(0))) && glm::all(glm::lessThan(b, count)))
                blocks_[std::size_t(b.x * stride_x_ + b.y * stride_y_ + b.z)] = values;
        },
        [&](const Voxel& origin, std::int64_t edge, float value) {
            const Voxel begin = glm::max(block_of(origin) - first, Voxel(0));
            const Voxel end = glm::min(block_of(origin + Voxel(edge)) - first, count);
            if (value == grid.tree().background() || !glm::all(glm::lessThan(begin, end))) return;
            const float* values = uniform(value);
            for (std::int64_t x = begin.x; x < end.x; ++x)
                for (std::int64_t y = begin.y; y < end.y; ++y)
                    for (std::int64_t z = begin.z; z < end.z; ++z)
                        blocks_[std::size_t(x * stride_x_ + y * stride_y_ + z)] = values;
        });
}

const float* BlockTable::uniform(float value) {
    const auto [at, is_new] = uniform_.try_emplace(value);
    if (is_new) at->second.fill(value);
    return at->second.data();
}

/// Through NanoVDB's tree.
float NanoCursor::sparse_lookup(const core::Vec3d& p) const {
    const core::Vec3d q = glm::clamp(p, core::Vec3d(-1e9), core::Vec3d(1e9)), whole = glm::floor(q);
    const nanovdb::Coord c(int(whole.x), int(whole.y), int(whole.z));
    const auto accessor = grid_.getAccessor();
    const auto at = [&](int x, int y, int z) { return accessor.getValue(c.offsetBy(x, y, z)); };
    return interpolate(float(q.x - whole.x), float(q.y - whole.y), float(q.z - whole.z), at(0, 0, 0),
                       at(0, 0, 1), at(0, 1, 0), at(0, 1, 1), at(1, 0, 0), at(1, 0, 1), at(1, 1, 0),
                       at(1, 1, 1));
}

MajorantGrid<float> nano_majorants(const VdbGrid& grid) {
    const float background = grid.background();
    if (grid.uniform()) return MajorantGrid<float>({background, background});
    MajorantGrid<float> majorants(grid.lower() - Voxel(1), grid.upper() + Voxel(1), {background, background});
    for_each_node(
        *grid.data().grid,
        [&](const Voxel& origin, const float* values) {
            majorants.add_block(origin, origin + Voxel(7), [&](const Voxel& v) {
                const Voxel local = v - origin;
                return values[(local.x << 6) | (local.y << 3) | local.z];
            });
        },
        [&](const Voxel& origin, std::int64_t edge, float value) {
            if (value != background) majorants.add_constant(origin, origin + Voxel(edge - 1), value);
        });
    majorants.finish(background);
    return majorants;
}

}  // namespace mote::media
