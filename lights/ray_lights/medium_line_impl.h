// Templates of medium_line.h.
#pragma once

#include "core/scene/transmittance_along.h"

namespace mote::lights {

template <typename Visit>
void for_each_medium_line(const RayThroughMedia& through, const ScatteringMedia& media, core::Rng& rng,
                          core::TrackingCounters& counters, const Visit& visit) {
    core::TransmittanceAlong along(through.ray, through.state, through.boundaries, rng, counters);
    float t = through.ray.t_min;
    for (std::size_t i = 0; i <= through.boundaries.size(); ++i) {
        const float end = i < through.boundaries.size() ? through.boundaries[i].t : through.t_end;
        const core::Rgb transmittance = along.advance_to(t);
        if (core::is_black(transmittance)) return;
        if (const MediumKind* kind = media.find(along.state().current()); kind && t < end)
            if (const auto line = make_medium_line(through.ray, t, end, *kind, rng, counters))
                visit(*line, along.state(), transmittance);
        t = end;
    }
}

}  // namespace mote::lights
