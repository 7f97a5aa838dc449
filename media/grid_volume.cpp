// Dense grids as volumes and as the extinction of a medium.
#include "media/grid_volume.h"

#include <fmt/format.h>

#include <filesystem>

#include "media/tracked_medium.h"
#include "media/vol_file.h"

namespace mote::media {

using core::Rgb, core::Transform, core::Vec3d;

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

const core::ParameterList<GridPlacement>& grid_placement_rows() {
    using namespace core;
    using S = GridPlacement;
    static const ParameterList<S> list{
        row("to_world", &S::to_world, "Places the unit cube (or the grid's own box) in the world."),
        row("use_grid_bbox", &S::use_grid_bbox, "Use the grid's own bounding box instead of the unit cube."),
        row("wrap_mode", &S::wrap,
            {{"clamp", WrapMode::clamp}, {"repeat", WrapMode::repeat}, {"mirror", WrapMode::mirror}},
            "Outside the grid: the border's voxels, the grid again, or reversed in turns.")};
    return list;
}

namespace {

enum class GridFilter : std::uint8_t { trilinear };

struct GridFileSettings : GridPlacement {
    core::FileName file;
    bool clamp_negative = false, raw = true;
    GridFilter filter = GridFilter::trilinear;
};

const core::ParameterList<GridFileSettings>& grid_file_rows() {
    using namespace core;
    using S = GridFileSettings;
    static const ParameterList<S> list{
        row("filename", &S::file, "The .vol file: float32, one or three channels.").required(),
        row("clamp_negative", &S::clamp_negative, "Raise negative voxels to 0 instead of refusing them."),
        row("filter_type", &S::filter, {{"trilinear", GridFilter::trilinear}}, "Interpolation."),
        grid_placement_rows(), row("raw", &S::raw, "Without effect: values are used as they are.")};
    return list;
}

std::shared_ptr<GridVolume> make_grid(const GridFileSettings& s, const core::Properties& p) {
    if (p.has("raw")) p.warn("gridvolume: 'raw' has no effect, values are used as they are");
    const std::string& path = s.file.path;
    VolFile file = read_vol_file(path, s.clamp_negative);
    if (file.clamped > 0)
        p.warn(fmt::format("{}: {} negative voxels raised to 0, the lowest was {}", path, file.clamped,
                           file.lowest));
    try {
        return std::make_shared<GridVolume>(std::move(file), s.to_world, s.use_grid_bbox,
                                            std::filesystem::path(path).filename().string(), s.wrap);
    } catch (const core::InputError& e) {
        throw core::InputError(e.what(), p.where);
    }
}

}  // namespace

void register_grid_volume(core::Registry& registry) {
    core::add_type(
        registry, core::Category::volume, "gridvolume",
        "A dense grid from a .vol file: cell-centred, trilinear. As an extinction it ends at its box, as in "
        "Mitsuba 3: the smallest one along the world's axes around the transformed unit cube (or file's "
        "box), with vacuum outside. `wrap_mode` says what lies in the corners between the two where the "
        "transform "
        "rotates or shears, what the half voxel between the last centre and the box's face is interpolated "
        "with, and how an albedo or an emission continues outside.",
        grid_file_rows(), R"(<volume type="gridvolume"><string name="filename" value="smoke.vol"/></volume>)",
        make_grid);
}

}  // namespace mote::media
