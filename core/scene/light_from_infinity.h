// Light from infinity and media without end: over an infinite distance nothing is transmitted.
#pragma once

#include "core/scene/emitter.h"
#include "core/scene/medium.h"
#include "core/scene/medium_state.h"

namespace mote::core {

/// True if no light comes through the medium from infinity.
inline bool blocks_infinity(const Medium& medium) {
    const Bounds3 box = medium.bounds();
    return medium.majorant() > 0.0f && !(is_finite(box.lower) && is_finite(box.upper));
}

/// False if a particle of the emitter that begins in these media has come through one without end: paths
/// from the eye find no such light.
inline bool reaches_scene(const Emitter& emitter, const MediumState& start) {
    return !emitter.traits().infinite || !start.current() || !blocks_infinity(*start.current());
}

}  // namespace mote::core
