// Parameters that the media share, read from a scene file.
#pragma once

#include <limits>
#include <memory>

#include "core/scene/phase_function.h"

namespace mote::core {
class Properties;
}

namespace mote::media {

/// The upper end of a range without one.
inline constexpr float unlimited = std::numeric_limits<float>::max();

/// The nested phase function, isotropic when there is none.
std::shared_ptr<core::PhaseFunction> phase_of(const core::Properties& properties);

}  // namespace mote::media
