// A quantity that varies over space: density, albedo, temperature. Nested in a heterogeneous medium.
//
// A volume also builds the medium whose extinction it is (make_medium): the tracking loops are
// compiled for each kind of grid, so that no virtual call is left inside them.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/math/vec.h"
#include "core/objects/object.h"
#include "core/parameters/add_type.h"

namespace mote::media {

class HeterogeneousMedium;
struct MediumParts;

class Volume : public core::Object {
  public:
    /// The value at a point of the world; grey volumes give the same value three times. Never negative.
    virtual core::Rgb eval(const core::Vec3& p) const = 0;
    /// No value exceeds this, per channel.
    virtual core::Rgb upper_bound() const = 0;
    /// The value, where it is the same everywhere.
    virtual std::optional<core::Rgb> constant() const { return std::nullopt; }
    /// The medium with the extinction `parts.scale` times this volume [1/m].
    virtual std::shared_ptr<HeterogeneousMedium> make_medium(MediumParts parts) const = 0;
};

/// A volume that others share.
using VolumePtr = std::shared_ptr<const Volume>;

/// A volume of one value.
VolumePtr make_constant_volume(float value);

/// Volumes as declared parameters: nested ones, or a constant from an rgb or a float.
const core::ValueKind& kind_of(core::Type<VolumePtr>);

}  // namespace mote::media
