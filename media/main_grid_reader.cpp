// mote_grid_reader: reads OpenVDB and NanoVDB files on behalf of mote, in a process that may crash.
//
// The only file of the project that includes OpenVDB to read files. It limits its own memory and time before
// it touches the file, reads without delayed loading, checks kind and values, and converts to NanoVDB within
// an inherited memory file (grid_reader_protocol.h). It leaves with _exit(), because the tree of a damaged
// file may crash in its destructor.
#include <nanovdb/util/IO.h>
#include <nanovdb/util/NanoToOpenVDB.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/ChangeBackground.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "media/grid_reader_protocol.h"

namespace {

using mote::media::GridReaderHeader;
using nlohmann::json;

struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Request {
    std::string mode, path, grid_name;
    bool clamp_negative = false;
};

void limit(int resource, rlim_t value) {
    const rlimit r{value, value};
    ::setrlimit(static_cast<__rlimit_resource>(resource), &r);
}

void limit_resources(std::uint64_t memory, long seconds) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, rlim_t(seconds));
#if !defined(MOTE_SANITIZED)  // whose shadow memory alone exceeds any limit
    limit(RLIMIT_AS, rlim_t(memory));
#else
    (void)memory;
#endif
    ::setenv("OPENVDB_DISABLE_DELAYED_LOAD", "1", 1);
}

std::string clip(std::string text, std::size_t length = 200) {
    if (text.size() > length) text = text.substr(0, length) + "...";
    return text;
}

void write_all(const void* from, std::size_t size, std::uint64_t offset) {
    const auto* in = static_cast<const char*>(from);
    while (size > 0) {
        const ssize_t n = ::pwrite(mote::media::grid_reader_descriptor, in, size, off_t(offset));
        if (n <= 0) ::_exit(4);
        in += n, offset += std::uint64_t(n), size -= std::size_t(n);
    }
}

std::uint64_t grid_offset() { return std::uint64_t(::sysconf(_SC_PAGESIZE)); }
static_assert(sizeof(GridReaderHeader) <= 4096, "the header fits into a page");

/// NanoVDB's memory: pages of the memory file, behind the header.
class AnswerBuffer {
  public:
    static AnswerBuffer create(std::uint64_t size, const AnswerBuffer* /*pool*/ = nullptr) {
        AnswerBuffer buffer;
        constexpr int fd = mote::media::grid_reader_descriptor;
        if (::ftruncate(fd, off_t(grid_offset() + size)) != 0) throw std::bad_alloc();
        void* pages = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, off_t(grid_offset()));
        if (pages == MAP_FAILED) throw std::bad_alloc();
        buffer.pages_ = static_cast<std::uint8_t*>(pages), buffer.size_ = size;
        return buffer;
    }
    std::uint8_t* data() const { return pages_; }
    std::uint64_t size() const { return size_; }
    void clear() {}  // the process ends before long

  private:
    std::uint8_t* pages_ = nullptr;
    std::uint64_t size_ = 0;
};

/// `grid_size`: of the AnswerBuffer, 0 without a grid.
void answer(const json& document, std::uint64_t grid_size = 0) {
    const std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
    GridReaderHeader h;
    h.grid_offset = grid_size > 0 ? grid_offset() : 0, h.grid_size = grid_size;
    h.text_offset = grid_size > 0 ? h.grid_offset + grid_size : sizeof h, h.text_size = text.size();
    write_all(text.data(), text.size(), h.text_offset);
    h.magic = GridReaderHeader::expected_magic;
    write_all(&h, sizeof h, 0);
}

/// The linear part from unit vectors and the translation from the origin: OpenVDB's own 4x4 form refuses
/// voxels smaller than about 1e-5.
json matrix_of(const openvdb::math::Transform& transform) {
    const auto map = transform.baseMap();
    json m = json::array();
    for (int column = 0; column < 4; ++column) {
        openvdb::Vec3d v(0.0);
        if (column < 3) v[column] = 1.0;
        v = column < 3 ? map->applyJacobian(v) : map->applyMap(v);
        for (int row = 0; row < 3; ++row) m.push_back(v[row]);
        m.push_back(column == 3 ? 1.0 : 0.0);
    }
    return m;
}

std::string list_of_names(openvdb::io::File& file) {
    std::string names;
    for (auto it = file.beginName(); it != file.endName(); ++it)
        names += (names.empty() ? "" : ", ") + clip(it.gridName(), 60);
    return names.empty() ? "the file holds no grid" : "grids present: " + clip(names, 400);
}

/// "density" for "density[1]", the name OpenVDB gives to the second of several.
std::string stripped(const std::string& unique) {
    const auto bracket = unique.rfind('[');
    return bracket != std::string::npos && !unique.empty() && unique.back() == ']' ? unique.substr(0, bracket)
                                                                                   : unique;
}

/// The unique name to read for the requested one.
std::string choose_grid(openvdb::io::File& file, const std::string& name, json& warnings) {
    std::vector<std::string> same_name;
    for (auto it = file.beginName(); it != file.endName(); ++it) {
        if (it.gridName() == name) return name;
        if (stripped(it.gridName()) == name) same_name.push_back(it.gridName());
    }
    if (same_name.empty()) throw Refusal("no grid named '" + clip(name, 60) + "'; " + list_of_names(file));
    if (same_name.size() > 1)
        warnings.push_back(std::to_string(same_name.size()) + " grids are named '" + clip(name, 60) +
                           "': the first is used; name '" + clip(same_name[1], 60) + "' for the second");
    return same_name.front();
}

template <typename GridType>
openvdb::FloatGrid::Ptr converted(const openvdb::GridBase::Ptr& base) {
    const auto typed = openvdb::gridPtrCast<GridType>(base);
    return typed ? std::make_shared<openvdb::FloatGrid>(*typed) : nullptr;
}

openvdb::FloatGrid::Ptr as_float(const openvdb::GridBase::Ptr& base, const std::string& named) {
    if (base->getGridClass() == openvdb::GRID_LEVEL_SET)
        throw Refusal(named + " is a level set, not a fog volume; convert it to one first");
    if (auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(base)) return grid;
    if (auto grid = converted<openvdb::DoubleGrid>(base)) return grid;
    if (auto grid = converted<openvdb::Int32Grid>(base)) return grid;
    if (auto grid = converted<openvdb::Int64Grid>(base)) return grid;
    throw Refusal(named + " holds values of type '" + clip(base->valueType(), 40) + "' (" +
                  clip(base->type(), 60) + "); only fog volumes of numbers are read");
}

/// Refuses NaN, infinite and negative values; clamps the latter on request. Counts what it clamped.
class ValueCheck {
  public:
    ValueCheck(std::string named, bool clamp) : named_(std::move(named)), clamp_(clamp) {}

    float operator()(float value, const openvdb::Coord& at) {
        if (std::isfinite(value) && value >= 0.0f) return value;
        const std::string where = named_ + ": voxel (" + std::to_string(at.x()) + ", " +
                                  std::to_string(at.y()) + ", " + std::to_string(at.z()) + ") is ";
        if (!std::isfinite(value)) throw Refusal(where + (std::isnan(value) ? "NaN" : "infinite"));
        if (!clamp_)
            throw Refusal(where + "negative (" + std::to_string(value) + "); set clamp_negative to use 0");
        ++clamped_;
        return 0.0f;
    }
    std::uint64_t clamped() const { return clamped_; }

  private:
    std::string named_;
    bool clamp_;
    std::uint64_t clamped_ = 0;
};

void check_values(openvdb::FloatGrid& grid, ValueCheck& check) {
    auto& tree = grid.tree();
    const float background = tree.background();
    if (!(std::isfinite(background) && background >= 0.0f))
        openvdb::tools::changeBackground(tree, check(background, openvdb::Coord(0)));
    for (auto leaf = tree.beginLeaf(); leaf; ++leaf) {
        float* values = leaf->buffer().data();
        for (openvdb::Index i = 0; i < leaf->SIZE; ++i)
            if (!(values[i] >= 0.0f && std::isfinite(values[i])))
                values[i] = check(values[i], leaf->offsetToGlobalCoord(i));
    }
    auto tile = tree.beginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllIter::LEAF_DEPTH - 1);
    for (; tile; ++tile)
        if (!(*tile >= 0.0f && std::isfinite(*tile))) tile.setValue(check(*tile, tile.getCoord()));
}

/// A grid of a NanoVDB file.
openvdb::GridBase::Ptr read_nano_grid(const Request& request) {
    std::string names;
    for (const auto& data : nanovdb::io::readGridMetaData(request.path)) {
        names += (names.empty() ? "grids present: " : ", ") + clip(data.gridName, 60);
        if (data.gridName != request.grid_name) continue;
        const auto handle = nanovdb::io::readGrid(request.path, data.gridName);
        if (const auto* grid = handle.grid<float>()) return nanovdb::nanoToOpenVDB(*grid);
        if (const auto* grid = handle.grid<nanovdb::Fp16>()) return nanovdb::nanoToOpenVDB(*grid);
        if (const auto* grid = handle.grid<nanovdb::FpN>()) return nanovdb::nanoToOpenVDB(*grid);
        throw Refusal("grid '" + clip(data.gridName, 60) + "' holds neither float, Fp16 nor FpN");
    }
    throw Refusal("no grid named '" + clip(request.grid_name, 60) + "'; " +
                  (names.empty() ? "the file holds no grid" : clip(names, 400)));
}

void read_grid(const Request& request) {
    json document, warnings = json::array();
    std::string name = request.grid_name;
    openvdb::GridBase::Ptr base;
    if (request.path.ends_with(".nvdb")) {
        base = read_nano_grid(request);
    } else {
        openvdb::io::File file(request.path);
        file.open(false);
        name = choose_grid(file, name, warnings);
        base = file.readGrid(name);
    }
    const std::string named = "grid '" + clip(name, 60) + "'";
    if (!base) throw Refusal(named + " cannot be read");
    if (!base->transform().isLinear())
        throw Refusal(named + " has a frustum transform; only linear ones are read");
    const auto grid = as_float(base, named);
    ValueCheck check(named, request.clamp_negative);
    check_values(*grid, check);

    document["name"] = clip(name);
    document["active_voxels"] = grid->activeVoxelCount();
    document["clamped"] = check.clamped();
    document["index_to_world"] = matrix_of(base->transform());
    document["warnings"] = warnings;
    grid->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
    grid->setName("");
    const auto handle =
        nanovdb::openToNanoVDB<AnswerBuffer>(*grid, nanovdb::StatsMode::BBox, nanovdb::ChecksumMode::Disable);
    answer(document, handle.size());
}

json describe(const openvdb::GridBase& grid, const std::string& name) {
    json d;
    d["name"] = clip(name);
    d["type"] = clip(grid.type(), 80) + (grid.saveFloatAsHalf() ? ", half" : "");
    d["class"] = openvdb::GridBase::gridClassToString(grid.getGridClass());
    d["active_voxels"] = grid.activeVoxelCount();
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    const bool any = grid.activeVoxelCount() > 0;
    for (int i = 0; i < 3; ++i) {
        d["lower"].push_back(any ? box.min()[i] : 0);
        d["upper"].push_back(any ? box.max()[i] : 0);
    }
    const auto size = grid.voxelSize();
    d["voxel_size"] = {size[0], size[1], size[2]};
    d["linear"] = grid.transform().isLinear();
    d["index_to_world"] = grid.transform().isLinear() ? matrix_of(grid.transform()) : json::array();
    d["warnings"] = json::array();
    const auto declared = grid.getMetadata<openvdb::Int64Metadata>(openvdb::GridBase::META_FILE_VOXEL_COUNT);
    if (declared && declared->value() != openvdb::Int64(grid.activeVoxelCount()))
        d["warnings"].push_back("the file declares " + std::to_string(declared->value()) + " active voxels");
    if (!any) d["warnings"].push_back("no active voxels");
    return d;
}

void list_grids(const Request& request) {
    openvdb::io::File file(request.path);
    file.open(false);
    json grids = json::array();
    for (auto it = file.beginName(); it != file.endName(); ++it) {
        const auto grid = file.readGrid(it.gridName());
        if (!grid) throw Refusal("grid '" + clip(it.gridName(), 60) + "' cannot be read");
        grids.push_back(describe(*grid, it.gridName()));
    }
    answer({{"grids", grids}});
}

/// In memory: as the file states it, or of its voxels; 0 where it says neither.
void size_grid(const Request& request) {
    double bytes = 0.0;
    if (request.path.ends_with(".nvdb")) {
        for (const auto& data : nanovdb::io::readGridMetaData(request.path))
            if (data.gridName == request.grid_name) bytes = double(data.gridSize);
    } else {
        openvdb::io::File file(request.path);
        file.open(false);
        json ignored = json::array();
        const auto grid = file.readGridMetadata(choose_grid(file, request.grid_name, ignored));
        const auto stated = [&](const char* name) {
            const auto value = grid->getMetadata<openvdb::Int64Metadata>(name);
            return value ? double(std::max<openvdb::Int64>(0, value->value())) : 0.0;
        };
        bytes = std::max(stated(openvdb::GridBase::META_FILE_MEM_BYTES),
                         double(sizeof(float)) * stated(openvdb::GridBase::META_FILE_VOXEL_COUNT));
    }
    answer({{"bytes", bytes}});
}

void run(const Request& request) {
    try {
        const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
        openvdb::initialize();
        if (request.mode == "list")
            list_grids(request);
        else if (request.mode == "sizes")
            size_grid(request);
        else
            read_grid(request);
    } catch (const Refusal& e) {
        answer({{"error", clip(e.what(), 600)}});
    } catch (const std::bad_alloc&) {
        answer({{"error", "needs more memory than a file of this size should; it may be damaged"}});
    } catch (const std::exception& e) {
        answer({{"error", "cannot be read: " + clip(e.what())}});
    }
}

}  // namespace

int main(int argc, char* argv[]) {
    if (argc != 7) return 2;
    limit_resources(std::strtoull(argv[3], nullptr, 10), std::strtol(argv[4], nullptr, 10));
    run({argv[1], argv[2], argv[6], argv[5] == std::string("1")});
    ::_exit(0);
}
