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
