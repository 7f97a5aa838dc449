// Parameters that the media share, read from a scene file.
#include "media/medium_parameters.h"

#include "core/objects/properties.h"
#include "media/phase_functions.h"

namespace mote::media {

std::shared_ptr<core::PhaseFunction> phase_of(const core::Properties& properties) {
    auto phase = properties.child_of<core::PhaseFunction>(core::Category::phase);
    return phase ? phase : std::make_shared<IsotropicPhase>();
}

}  // namespace mote::media
