// Numbers of rays cast, by kind.
#pragma once

#include <cstdint>

namespace mote::core {

/// Counters that one task fills without synchronisation; merged at the end of the task.
struct RayCounters {
    /// Calls: for closest hits, for occlusion tests, for the boundaries along a ray.
    std::uint64_t closest = 0, occlusion = 0, boundary = 0;
    /// Adds what another task counted.
    void add(const RayCounters& o) { closest += o.closest, occlusion += o.occlusion, boundary += o.boundary; }
};

}  // namespace mote::core
