#include "core/scene/transmittance_along.h"

#include "core/scene/media_along.h"

namespace mote::core {

void TransmittanceAlong::pass(float t) {
    const Medium* medium = state_.current();
    if (medium && t_ < t && !is_black(transmittance_))
        transmittance_ *= medium->transmittance(Ray{ray_.origin, ray_.direction, t_, t}, rng_, counters_);
    t_ = std::fmax(t_, t);
}

Rgb TransmittanceAlong::advance_to(float t) {
    while (!boundaries_.empty() && boundaries_.front().t <= t) {
        const SurfaceHit& boundary = boundaries_.front();
        pass(boundary.t);
        if (is_pane(boundary)) transmittance_ *= passage_through(boundary, ray_.direction).transmittance();
        state_.cross(*boundary.shape, boundary.geometric_normal, ray_.direction);
        boundaries_ = boundaries_.subspan(1);
    }
    pass(t);
    return transmittance_;
}

}  // namespace mote::core
