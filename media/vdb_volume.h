// <volume type="vdbvolume">: a grid of an OpenVDB file under any linear transform, trilinear, its background
// outside.
#pragma once

#include "core/math/transform.h"
#include "media/volume.h"

namespace mote::core {
class Registry;
}

namespace mote::media {

class VdbGrid;

class VdbVolume final : public Volume {
  public:
    /// `to_world` is applied after the grid's own transform. Throws InputError when the product is singular.
    VdbVolume(std::shared_ptr<const VdbGrid> grid, const core::Transform& to_world = {});
    core::Rgb eval(const core::Vec3& p) const override;
    core::Rgb upper_bound() const override;
    std::shared_ptr<HeterogeneousMedium> make_medium(MediumParts parts) const override;
    const VdbGrid& grid() const { return *grid_; }
    const core::Transform& world_to_index() const { return world_to_index_; }

  private:
    std::shared_ptr<const VdbGrid> grid_;
    core::Transform world_to_index_;
};

void register_vdb_volume(core::Registry& registry);

}  // namespace mote::media
