// Two loops timed in turns within one run, and their ratio as Google Benchmark reports it.
//
// Turns cancel what drifts (clock rate, other programs); CPU time of the one thread cancels preemption. The
// ratio reported is the median over turns of (mote's time / bare time).
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace mote::benchmarks {

/// Target of a ratio that is reported for information alone.
inline constexpr double no_target = 0.0;

inline double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

template <typename F>
double seconds_of(F&& f) {
    const double start = thread_seconds();
    f();
    return thread_seconds() - start;
}

inline double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Runs `ours` and `bare`, which return the seconds that they took, once each per iteration, the first of
/// them alternating. `operations` is what one run of `bare` does (rays, lookups), for absolute rates.
/// Register with UseManualTime().
template <typename Ours, typename Bare>
void take_turns(benchmark::State& state, double target, double operations, Ours&& ours, Bare&& bare) {
    ours(), bare();  // warm caches and first-touch memory
    std::vector<double> ratios, ours_seconds, bare_seconds;
    for (auto _ : state) {
        double a, b;
        if (ratios.size() % 2 == 0) {
            a = ours(), b = bare();
        } else {
            b = bare(), a = ours();
        }
        ratios.push_back(a / b), ours_seconds.push_back(a), bare_seconds.push_back(b);
        state.SetIterationTime(a);
    }
    state.counters["ratio"] = median(ratios);
    state.counters["target"] = target;
    state.counters["ours_M_per_s"] = 1e-6 * operations / median(ours_seconds);
    state.counters["bare_M_per_s"] = 1e-6 * operations / median(bare_seconds);
}

}  // namespace mote::benchmarks
