// VDB grids as volumes and as the extinction of a medium.
#include "media/vdb_volume.h"

#include <fmt/format.h>

#include "core/objects/properties.h"
#include "core/objects/registry.h"
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

void register_vdb_volume(core::Registry& registry) {
    registry.add(
        {core::Category::volume,
         "vdbvolume",
         "A fog volume of an OpenVDB file (float, half, double, integers): trilinear, its background "
         "outside.",
         {{"filename", "string", "", "The .vdb file."},
          {"grid", "string", "density", "Name of the grid; 'name[1]' is the second of several of one name."},
          {"to_world", "transform", "identity", "Applied after the grid's own transform; any linear one."},
          {"clamp_negative", "boolean", "false", "Raise negative values to 0 instead of refusing them."}},
         R"(<volume type="vdbvolume"><string name="filename" value="smoke.vdb"/></volume>)"},
        [](const core::Properties& p) {
            const std::string path = p.require_file("filename");
            VdbLoadOptions options;
            options.clamp_negative = p.get_bool("clamp_negative", false);
            const auto grid = load_vdb_grid(path, p.get_string("grid", "density"), options);
            for (const std::string& w : grid->warnings())
                p.warn(fmt::format("{}: grid '{}': {}", path, grid->name(), w));
            const Transform to_world = p.get_transform();
            if (!(to_world * grid->index_to_world()).valid())
                throw core::InputError("the grid's transform is singular or not finite",
                                       p.where_of("to_world"));
            return std::make_shared<VdbVolume>(grid, to_world);
        });
}

}  // namespace mote::media
