// <volume type="gridvolume">: a dense grid from a .vol file, as Mitsuba 3 places it: cell-centred voxels in
// the unit cube (or the file's own box), trilinear. As the extinction of a medium it ends there: outside of
// the box that is vacuum. Other volumes (albedo, emission) continue by the wrap mode.
#pragma once

#include "core/math/transform.h"
#include "media/dense_grid.h"
#include "media/volume.h"

namespace mote::core {
class Registry;
}

namespace mote::media {

struct VolFile;

class GridVolume final : public Volume {
  public:
    /// Throws InputError when `to_world` or the file's box is singular.
    GridVolume(VolFile file, const core::Transform& to_world, bool use_grid_bbox, std::string name,
               WrapMode wrap = WrapMode::clamp);
    core::Rgb eval(const core::Vec3& p) const override;
    core::Rgb upper_bound() const override { return upper_bound_; }
    std::shared_ptr<HeterogeneousMedium> make_medium(MediumParts parts) const override;

  private:
    std::shared_ptr<const DenseVoxels> voxels_;
    core::Transform world_to_index_;
    WorldBox box_;
    core::Rgb upper_bound_{0.0f};
    std::string description_;
};

/// Where a grid lies, and its continuation outside.
struct GridPlacement {
    core::Transform to_world;
    bool use_grid_bbox = false;
    WrapMode wrap = WrapMode::clamp;
};
const core::ParameterList<GridPlacement>& grid_placement_rows();

void register_grid_volume(core::Registry& registry);

}  // namespace mote::media
