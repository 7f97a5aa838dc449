// Heuristics of multiple importance sampling (Veach 1997, Sec. 9.2) as a function of one ratio of densities.
#pragma once

#include <algorithm>
#include <cstdint>

namespace mote::integrators {

enum class Heuristic : std::uint8_t {
    power,    ///< h(p) = p^2
    balance,  ///< h(p) = p
    none      ///< every technique counts in full: to compare them one by one
};

/// h of a ratio of densities. The largest numbers are cut off long before they overflow: what they stand
/// beside has no weight left.
inline double mis_term(Heuristic heuristic, double ratio) {
    if (heuristic == Heuristic::none) return 0.0;
    const double r = std::min(ratio, 1e50);
    return heuristic == Heuristic::power ? r * r : r;
}

}  // namespace mote::integrators
