// Named numbers that a render reports: rays, lookups, VPLs, seconds. Written as stats.json.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace mote::core {

struct Statistics {
    std::map<std::string, std::uint64_t> rays;     ///< "closest", "occlusion", "boundary"
    std::map<std::string, std::uint64_t> lookups;  ///< "density", "collisions"
    std::map<std::string, double> seconds;         ///< "load", "build", "render", "finish"
    std::map<std::string, double> values;          ///< "vpls", "bound", ...
    std::vector<std::string> warnings;
    std::uint64_t non_finite_samples = 0;  ///< pixels of passes with NaN or infinity (not added to the film)
    std::uint64_t clamped_samples = 0;     ///< 0 unless clamping is enabled
};

}  // namespace mote::core
