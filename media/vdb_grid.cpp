// Loading VDB grids through the helper program.
#include "media/vdb_grid.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/files/whole_file.h"
#include "core/objects/error.h"
#include "media/grid_reader_process.h"
#include "media/nano_grid.h"

namespace mote::media {

using core::InputError, core::printable;
using nlohmann::json;

namespace {

/// The helper's JSON; its own refusals become InputErrors. The text stems from an untrusted file.
json parsed(const std::string& text, const std::string& path) {
    const json document = json::parse(text, nullptr, false);
    if (!document.is_object()) throw InputError("the reader's answer makes no sense", {path, 0});
    if (document.contains("error"))
        throw InputError(printable(document["error"].get<std::string>(), 700), {path, 0});
    return document;
}

core::Transform transform_of(const json& numbers) {
    core::Transform t;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            t.matrix[column][row] = numbers.at(std::size_t(4 * column + row)).get<double>();
    return t;
}

std::vector<std::string> warnings_of(const json& list) {
    std::vector<std::string> warnings;
    for (const json& w : list) warnings.push_back(printable(w.get<std::string>(), 300));
    return warnings;
}

/// Calls body(); a JSON document of another shape than expected is the helper's fault, not ours.
template <typename Body>
auto with_answer(const std::string& path, Body&& body) {
    try {
        return body();
    } catch (const json::exception&) {
        throw InputError("the reader's answer makes no sense", {path, 0});
    }
}

/// Range of the values, and the box of those that differ from the background.
void measure(VdbGrid::Data& d, const std::string& path) {
    d.background = d.grid->tree().background();
    d.max_value = d.background;
    d.lower = Voxel(std::numeric_limits<std::int64_t>::max());
    d.upper = Voxel(std::numeric_limits<std::int64_t>::min());
    const auto meet = [&](float v, const Voxel& first, const Voxel& last) {
        if (!(v >= 0.0f && std::isfinite(v))) throw InputError("the reader passed a bad value", {path, 0});
        d.max_value = std::max(d.max_value, v);
        if (v != d.background) d.lower = glm::min(d.lower, first), d.upper = glm::max(d.upper, last);
    };
    for_each_node(
        *d.grid,
        [&](const Voxel& origin, const float* values) {
            for (int i = 0; i < 512; ++i) {
                const Voxel v = origin + Voxel(i >> 6, (i >> 3) & 7, i & 7);
                meet(values[i], v, v);
            }
        },
        [&](const Voxel& origin, std::int64_t edge, float v) { meet(v, origin, origin + Voxel(edge - 1)); });
    meet(d.background, Voxel(0), Voxel(0));
    d.uniform = d.lower.x > d.upper.x;
    for (int axis = 0; axis < 3 && !d.uniform; ++axis)
        if (d.lower[axis] < -999'999'999 || d.upper[axis] > 999'999'999)
            throw InputError("the grid reaches beyond voxel 1e9", {path, 0});
}

}  // namespace

VdbGrid::VdbGrid(std::unique_ptr<Data> data) : data_(std::move(data)) {
    const Voxel none(0);
    data_->table = data_->uniform ? BlockTable(*data_->grid, none, none)
                                  : BlockTable(*data_->grid, data_->lower, data_->upper);
}
VdbGrid::~VdbGrid() = default;
const std::string& VdbGrid::name() const { return data_->name; }
const core::Transform& VdbGrid::index_to_world() const { return data_->index_to_world; }
float VdbGrid::background() const { return data_->background; }
float VdbGrid::max_value() const { return data_->max_value; }
const Voxel& VdbGrid::lower() const { return data_->lower; }
const Voxel& VdbGrid::upper() const { return data_->upper; }
bool VdbGrid::uniform() const { return data_->uniform; }
std::uint64_t VdbGrid::active_voxels() const { return data_->active_voxels; }
std::uint64_t VdbGrid::bytes() const { return data_->buffer.size() + data_->table.bytes(); }
std::uint64_t VdbGrid::clamped_voxels() const { return data_->clamped; }
const std::vector<std::string>& VdbGrid::warnings() const { return data_->warnings; }

std::shared_ptr<const VdbGrid> load_vdb_grid(const std::string& path, const std::string& grid_name,
                                             const VdbLoadOptions& options) {
    GridReaderAnswer answer = run_grid_reader("read", path, grid_name, options);
    const json document = parsed(answer.text, path);
    auto data = std::make_unique<VdbGrid::Data>();
    with_answer(path, [&] {
        data->name = printable(document.at("name").get<std::string>());
        data->active_voxels = document.at("active_voxels").get<std::uint64_t>();
        data->clamped = document.at("clamped").get<std::uint64_t>();
        data->index_to_world = transform_of(document.at("index_to_world"));
        data->warnings = warnings_of(document.at("warnings"));
    });
    if (!data->index_to_world.valid())
        throw InputError(fmt::format("grid '{}' has a singular or infinite transform", data->name),
                         {path, 0});
    data->buffer = std::move(answer.buffer);
    data->grid = checked_nano_grid(data->buffer, path);
    measure(*data, path);
    if (data->clamped > 0)
        data->warnings.push_back(fmt::format("{} negative values raised to 0", data->clamped));
    if (data->max_value == 0.0f) data->warnings.push_back("the grid is empty");
    if (data->background > 0.0f)
        data->warnings.push_back(
            fmt::format("the background is {}: the medium continues beyond the grid, up to its boundary",
                        data->background));
    return std::make_shared<VdbGrid>(std::move(data));
}

double vdb_grid_memory(const std::string& path, const std::string& grid_name, double small) {
    const auto size = double(core::size_of_file(path));
    if (size < small) return size;  // the helper would take longer than reading it
    const json document = parsed(run_grid_reader("sizes", path, grid_name, {}).text, path);
    // No grid compresses better than this: metadata that say more are damaged.
    constexpr double best_compression = 1000.0;
    return with_answer(path, [&] {
        const double bytes = document.at("bytes").get<double>();
        return bytes > 0.0 ? std::min(bytes, best_compression * size) : size;
    });
}

std::vector<VdbGridInfo> list_vdb_grids(const std::string& path, const VdbLoadOptions& options) {
    const GridReaderAnswer answer = run_grid_reader("list", path, "", options);
    const json document = parsed(answer.text, path);
    return with_answer(path, [&] {
        std::vector<VdbGridInfo> grids;
        for (const json& g : document.at("grids")) {
            VdbGridInfo info;
            info.name = printable(g.at("name").get<std::string>());
            info.type = printable(g.at("type").get<std::string>());
            info.grid_class = printable(g.at("class").get<std::string>());
            info.active_voxels = g.at("active_voxels").get<std::uint64_t>();
            info.linear = g.at("linear").get<bool>();
            if (info.linear) info.index_to_world = transform_of(g.at("index_to_world"));
            for (int i = 0; i < 3; ++i) {
                info.lower[i] = g.at("lower").at(std::size_t(i)).get<int>();
                info.upper[i] = g.at("upper").at(std::size_t(i)).get<int>();
                info.voxel_size[i] = g.at("voxel_size").at(std::size_t(i)).get<double>();
            }
            info.warnings = warnings_of(g.at("warnings"));
            grids.push_back(std::move(info));
        }
        return grids;
    });
}

void lookup_density(const VdbGrid& grid, std::span<const core::Vec3d> index_positions,
                    std::span<float> values) {
    NanoCursor cursor(grid);
    for (std::size_t i = 0; i < index_positions.size(); ++i) values[i] = cursor.lookup(index_positions[i]);
}

}  // namespace mote::media
