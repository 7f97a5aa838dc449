// Pixels of a film in parallel, which are independent of each other.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace mote::core {

inline constexpr std::size_t pixel_grain = 4096;  ///< pixels a task: large enough to hide the scheduling

/// Calls body(p) for p from 0 to pixels - 1.
template <typename Body>
void for_each_pixel(std::size_t pixels, const Body& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels, pixel_grain), [&](const auto& range) {
        for (std::size_t p = range.begin(); p < range.end(); ++p) body(p);
    });
}

}  // namespace mote::core
