// Dense grids as volumes and as the extinction of a medium.
#include "media/grid_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "media/tracked_medium.h"
#include "media/vol_file.h"

namespace mote::media {

using core::Rgb, core::Transform, core::Vec3d;

namespace {

const std::vector<std::string> wrap_names = {"clamp", "repeat", "mirror"};  // as in WrapMode

}  // namespace

GridVolume::GridVolume(VolFile file, const Transform& to_world, bool use_grid_bbox, std::string name,
                       WrapMode wrap) {
    Vec3d lower(0.0), upper(1.0);
    if (use_grid_bbox) lower = Vec3d(file.bounds.lower), upper = Vec3d(file.bounds.upper);
    // Voxel i of n has its centre at (i + 1/2) / n of the box.
    glm::dmat4 m = glm::scale(glm::translate(glm::dmat4(1.0), lower), upper - lower);
    m = glm::translate(glm::scale(m, 1.0 / Vec3d(file.resolution)), Vec3d(0.5));
    const Transform index_to_world = to_world * Transform(m);
    if (!index_to_world.valid())
        throw core::InputError("the grid's transform or bounding box is singular or not finite");
    world_to_index_ = index_to_world.inverse();
    box_ = WorldBox::around(lower, upper, to_world);
    const std::size_t step = std::size_t(file.channels);
    for (std::size_t i = 0; i < file.values.size(); i += step)
        upper_bound_ =
            glm::max(upper_bound_, step == 1 ? Rgb(file.values[i])
                                             : Rgb(file.values[i], file.values[i + 1], file.values[i + 2]));
    description_ =
        fmt::format("gridvolume '{}' {}x{}x{}, {:.1f} MB", core::printable(name, 40), file.resolution.x,
                    file.resolution.y, file.resolution.z, double(file.values.size() * sizeof(float)) * 1e-6);
    voxels_ = std::make_shared<DenseVoxels>(
        DenseVoxels{file.resolution, file.channels, std::move(file.values), wrap});
}

Rgb GridVolume::eval(const core::Vec3& p) const {
    const Vec3d index = world_to_index_.point(Vec3d(p));
    return voxels_->channels == 1 ? Rgb(voxels_->interpolate<float>(index))
                                  : voxels_->interpolate<Rgb>(index);
}

std::shared_ptr<HeterogeneousMedium> GridVolume::make_medium(MediumParts parts) const {
    const auto make = [&]<typename V>(V) -> std::shared_ptr<HeterogeneousMedium> {
        DenseGrid<V> grid{voxels_, world_to_index_, dense_majorants<V>(*voxels_), description_, box_};
        return std::make_shared<TrackedMedium<DenseGrid<V>>>(std::move(grid), std::move(parts));
    };
    return voxels_->channels == 1 ? make(0.0f) : make(Rgb(0.0f));
}

void register_grid_volume(core::Registry& registry) {
    registry.add(
        {core::Category::volume,
         "gridvolume",
         "A dense grid from a .vol file: cell-centred, trilinear. As an extinction it ends at its box, as in "
         "Mitsuba 3: the smallest one along the world's axes around the transformed unit cube (or file's "
         "box), "
         "with vacuum outside. `wrap_mode` says what lies in the corners between the two where the transform "
         "rotates or shears, what the half voxel between the last centre and the box's face is interpolated "
         "with, and how an albedo or an emission goes on outside.",
         {{"filename", "string", "", "The .vol file: float32, one or three channels."},
          {"to_world", "transform", "identity", "Places the unit cube (or the file's box) in the world."},
          {"use_grid_bbox", "boolean", "false", "Use the bounding box in the file instead of the unit cube."},
          {"clamp_negative", "boolean", "false", "Raise negative voxels to 0 instead of refusing them."},
          {"filter_type", "string", "trilinear", "Only trilinear."},
          {"wrap_mode", "string", "clamp",
           "Outside the grid: clamp (the border's voxels), repeat (the grid again) or mirror (reversed in "
           "turns)."},
          {"raw", "boolean", "true", "Without effect: values are used as they are."}},
         R"(<volume type="gridvolume"><string name="filename" value="smoke.vol"/></volume>)"},
        [](const core::Properties& p) {
            p.get_choice("filter_type", "trilinear", {"trilinear"});
            const std::string wrap = p.get_choice("wrap_mode", "clamp", wrap_names);
            const auto mode =
                WrapMode(std::find(wrap_names.begin(), wrap_names.end(), wrap) - wrap_names.begin());
            if (p.has("raw")) p.warn("gridvolume: 'raw' has no effect, values are used as they are");
            const std::string path = p.require_file("filename");
            VolFile file = read_vol_file(path, p.get_bool("clamp_negative", false));
            if (file.clamped > 0)
                p.warn(fmt::format("{}: {} negative voxels raised to 0, the lowest was {}", path,
                                   file.clamped, file.lowest));
            try {
                return std::make_shared<GridVolume>(std::move(file), p.get_transform(),
                                                    p.get_bool("use_grid_bbox", false),
                                                    std::filesystem::path(path).filename().string(), mode);
            } catch (const core::InputError& e) {
                throw core::InputError(e.what(), p.where);
            }
        });
}

}  // namespace mote::media
