// Processor time, which measures work independently of other users of the machine, and wall time.
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
/// Wall time [s].
inline double wall_seconds() { return read_clock(CLOCK_MONOTONIC); }

/// Adds the wall time of its scope to a sum [s].
class Stopwatch {
  public:
    explicit Stopwatch(double& sum) : sum_(sum), begin_(wall_seconds()) {}
    ~Stopwatch() { sum_ += wall_seconds() - begin_; }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

  private:
    double& sum_;
    double begin_;
};

}  // namespace mote::core
