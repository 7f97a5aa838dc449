// MOTE_INDEPENDENT_LANES before a loop tells the compiler that its iterations do not depend on each other
// through memory, which it cannot prove once references have been inlined away.
#pragma once

#if defined(__clang__)
#define MOTE_INDEPENDENT_LANES _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define MOTE_INDEPENDENT_LANES _Pragma("GCC ivdep")
#else
#define MOTE_INDEPENDENT_LANES
#endif
