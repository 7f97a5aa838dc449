// <volume type="constvolume">: the same value everywhere. As the extinction of a medium it ends at the unit
// cube under its to_world, where one is given, as in Mitsuba 3.
#pragma once

#include "core/math/transform.h"
#include "media/volume.h"

namespace mote::core {
class Registry;
}

namespace mote::media {

class ConstantVolume final : public Volume {
  public:
    /// Throws InputError for a negative or non-finite value.
    explicit ConstantVolume(const core::Rgb& value, std::optional<core::Transform> to_world = {});
    core::Rgb eval(const core::Vec3&) const override { return value_; }
    core::Rgb upper_bound() const override { return value_; }
    std::optional<core::Rgb> constant() const override { return value_; }
    std::shared_ptr<HeterogeneousMedium> make_medium(MediumParts parts) const override;

  private:
    core::Rgb value_;
    std::optional<core::Transform> to_world_;
};

void register_constant_volume(core::Registry& registry);

}  // namespace mote::media
