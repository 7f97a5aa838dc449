// Estimates of one segment's transport through the Medium interface, as an integrator would form them.
//
// `escape` and `connection` are the two techniques for light arriving through the segment: by unidirectional
// tracking alone, and by a connection alone. `two_techniques` adds both under the balance heuristic, the
// hero sampled uniformly. All three must have the transmittance as their mean, whatever the medium's
// spectrum; `collision` must have the scattered share as its mean.
#pragma once

#include <array>

#include "core/scene/medium.h"
#include "tests/media/statistics.h"

namespace mote::tests {

struct SpectralEstimates {
    std::array<Mean, 3> escape, collision, connection, two_techniques, transmittance, emitted;
    core::TrackingCounters counters;
};

inline SpectralEstimates spectral_estimates(const core::Medium& medium, const core::Ray& ray, int count,
                                            std::uint64_t seed) {
    SpectralEstimates e;
    core::Rng rng(seed);
    for (int i = 0; i < count; ++i) {
        core::PathWeights path, connected;
        path.light = connected.light = core::Rgb(1.0f);  // as after a scattering of density 1
        path.hero = connected.hero = int(rng.next_u32() % 3);
        core::Rgb emitted(0.0f);
        const bool escaped = !medium.sample_collision(ray, path, emitted, rng, e.counters);
        medium.connect(ray, connected, rng, e.counters);
        const core::Rgb t = medium.transmittance(ray, rng, e.counters);
        const float single = core::average(path.unidirectional);
        const float both = core::average(path.unidirectional + path.light);
        const float both_connected = core::average(connected.unidirectional + connected.light);
        for (int c = 0; c < 3; ++c) {
            e.escape[std::size_t(c)].add(escaped ? path.throughput[c] / single : 0.0);
            e.collision[std::size_t(c)].add(escaped ? 0.0 : path.throughput[c] / single);
            e.connection[std::size_t(c)].add(connected.throughput[c] / core::average(connected.light));
            e.two_techniques[std::size_t(c)].add((escaped ? path.throughput[c] / both : 0.0) +
                                                 connected.throughput[c] / both_connected);
            e.transmittance[std::size_t(c)].add(t[c]);
            e.emitted[std::size_t(c)].add(emitted[c]);
        }
    }
    return e;
}

}  // namespace mote::tests
