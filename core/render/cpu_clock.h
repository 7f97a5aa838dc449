// Processor time, which measures work independently of other users of the machine.
#pragma once

#include <time.h>

namespace mote::core {

inline double read_clock(clockid_t clock) {
    timespec t{};
    ::clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Processor time of the calling thread [s].
inline double thread_cpu_seconds() { return read_clock(CLOCK_THREAD_CPUTIME_ID); }
/// Processor time of all threads of the process [s].
inline double process_cpu_seconds() { return read_clock(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace mote::core
