// Extent of a shadow ray towards its target.
#pragma once

namespace mote::core {

/// Shadow rays stop at this fraction of the segment: rounding must not let them hit the surface at their own
/// end.
inline constexpr float shadow_fraction = 0.9999f;

}  // namespace mote::core
