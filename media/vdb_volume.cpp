// VDB grids as volumes and as the extinction of a medium.
#include "media/vdb_volume.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <mutex>
#include <system_error>

#include "core/parameters/add_type.h"
#include "media/nano_grid.h"
#include "media/tracked_medium.h"

namespace mote::media {

using core::Rgb, core::Transform, core::Vec3d;

VdbVolume::VdbVolume(std::shared_ptr<const VdbGrid> grid, const Transform& to_world)
    : grid_(std::move(grid)) {
    const Transform index_to_world = to_world * grid_->index_to_world();
    if (!index_to_world.valid()) throw core::InputError("the grid's transform is singular or not finite");
    world_to_index_ = index_to_world.inverse();
}

Rgb VdbVolume::eval(const core::Vec3& p) const {
    return Rgb(NanoCursor(*grid_).lookup(world_to_index_.point(Vec3d(p))));
}

Rgb VdbVolume::upper_bound() const { return Rgb(grid_->max_value()); }

std::shared_ptr<HeterogeneousMedium> VdbVolume::make_medium(MediumParts parts) const {
    const Voxel size = grid_->uniform() ? Voxel(0) : grid_->upper() - grid_->lower() + Voxel(1);
    NanoGrid grid{grid_, world_to_index_, nano_majorants(*grid_),
                  fmt::format("vdbvolume '{}' {}x{}x{}, {:.1f} MB", grid_->name(), size.x, size.y, size.z,
                              double(grid_->bytes()) * 1e-6)};
    return std::make_shared<TrackedMedium<NanoGrid>>(std::move(grid), std::move(parts));
}

namespace {

struct VdbSettings {
    core::FileName file;
    std::string grid = "density";
    Transform to_world;
    VdbLoadOptions options;
};

const core::ParameterList<VdbSettings>& vdb_rows() {
    using namespace core;
    using S = VdbSettings;
    static const ParameterList<S> list{
        row("filename", &S::file, "The .vdb file.").required(),
        row("grid", &S::grid, "Name of the grid; 'name[1]' is the second of several of one name."),
        row("to_world", &S::to_world, "Applied after the grid's own transform; any linear one."),
        within(&S::options, row("clamp_negative", &VdbLoadOptions::clamp_negative,
                                "Raise negative values to 0 instead of refusing them."))};
    return list;
}

/// Grids that a scene still holds, so that it is loaded again with other settings without reading them. For
/// several threads: the viewer's renders load their scenes by one registry, each in its own.
class KeptGrids {
  public:
    std::shared_ptr<const VdbGrid> get(const VdbSettings& s) {
        std::error_code unknown;  // a file that is not there is the reader's to report
        const auto written =
            std::filesystem::last_write_time(s.file.path, unknown).time_since_epoch().count();
        const auto size = std::filesystem::file_size(s.file.path, unknown);
        const std::lock_guard lock(mutex_);
        auto& kept = grids_[fmt::format("{} {} {} {} {}", written, size, s.options.clamp_negative, s.grid,
                                        s.file.path)];
        std::shared_ptr<const VdbGrid> grid = kept.lock();
        if (!grid) kept = grid = load_vdb_grid(s.file.path, s.grid, s.options);
        return grid;
    }

  private:
    std::mutex mutex_;
    std::map<std::string, std::weak_ptr<const VdbGrid>> grids_;
};

std::shared_ptr<VdbVolume> make_vdb(const VdbSettings& s, const core::Properties& p, KeptGrids& kept) {
    const auto grid = kept.get(s);
    for (const std::string& w : grid->warnings())
        p.warn(fmt::format("{}: grid '{}': {}", s.file.path, grid->name(), w));
    if (!(s.to_world * grid->index_to_world()).valid())
        throw core::InputError("the grid's transform is singular or not finite", p.where_of("to_world"));
    return std::make_shared<VdbVolume>(grid, s.to_world);
}

}  // namespace

void register_vdb_volume(core::Registry& registry) {
    core::add_type(
        registry, core::Category::volume, "vdbvolume",
        "A fog volume of an OpenVDB file (float, half, double, integers) or a NanoVDB one (.nvdb; float, "
        "Fp16, FpN): trilinear, its background outside.",
        vdb_rows(), R"(<volume type="vdbvolume"><string name="filename" value="smoke.vdb"/></volume>)",
        [kept = std::make_shared<KeptGrids>()](const VdbSettings& s, const core::Properties& p) {
            return make_vdb(s, p, *kept);
        });
    registry.set_file_memory(core::Category::volume, "vdbvolume", [](const core::Properties& p) {
        const auto grid = p.values.find("grid");
        const std::string name =
            grid == p.values.end() ? VdbSettings().grid : std::get<std::string>(grid->second.value);
        return vdb_grid_memory(p.find_file("filename"), name);
    });
}

}  // namespace mote::media
