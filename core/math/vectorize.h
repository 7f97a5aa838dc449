// MOTE_INDEPENDENT_LANES before a loop asserts to the compiler that its iterations do not depend on each
// other through memory, which it cannot prove once references have been inlined away. And what such loops
// use.
#pragma once

#if defined(__clang__)
#define MOTE_INDEPENDENT_LANES _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define MOTE_INDEPENDENT_LANES _Pragma("GCC ivdep")
#else
#define MOTE_INDEPENDENT_LANES
#endif

namespace mote::core {

// Without a branch, as vector code has them; std::min and std::max take references. NaN turns into b.
inline float min_of(float a, float b) { return a < b ? a : b; }
inline float max_of(float a, float b) { return a > b ? a : b; }

}  // namespace mote::core
