// Granular visibility queries on 1920 x 1080 pixels with 4096 objects, against a bare pass over the picture
// (the sum of its numbers) on one thread, and their time on two.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>
#include <functional>
#include <numeric>

#include "experiments/benchmarks/ellipse_picture.h"
#include "experiments/benchmarks/turns.h"
#include "screenspace/visibility/item_histogram.h"
#include "screenspace/visibility/region_queries.h"

namespace mote::benchmarks {
namespace {

using namespace screenspace;

constexpr std::uint32_t objects = 4096;

/// Three of four pixels show something, one before up to ten others.
const EllipsePicture& picture() {
    static const EllipsePicture made = make_ellipses({.width = 1920,
                                                      .height = 1080,
                                                      .count = int(objects),
                                                      .min_radius = 12.0f,
                                                      .largest_radius = 30.0f,
                                                      .aspect = 2.0f,
                                                      .spread = 1.0f});
    return made;
}

template <typename Queries>
std::uint64_t all_pixels(const Queries& queries) {
    std::uint64_t sum = 0;
    for (std::uint32_t item = 0; item < objects; ++item) sum += queries.pixels(item);
    return sum;
}

double milliseconds_on_two_threads(const std::function<std::uint64_t()>& work) {
    const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
    std::vector<double> taken;
    for (int i = 0; i < 21; ++i) {
        const auto start = std::chrono::steady_clock::now();
        benchmark::DoNotOptimize(work());
        taken.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    return median(taken);
}

void against_bare_pass(benchmark::State& state, const std::function<std::uint64_t()>& work,
                       double target_ms) {
    const std::vector<std::uint32_t>& items = picture().items;
    const double wall = milliseconds_on_two_threads(work);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    take_turns(
        state, no_target, double(items.size()),
        [&] { return seconds_of([&] { benchmark::DoNotOptimize(work()); }); },
        [&] {
            return seconds_of([&] {
                benchmark::DoNotOptimize(std::accumulate(items.begin(), items.end(), std::uint64_t(0)));
            });
        });
    state.counters["ms_on_two_threads"] = wall;
    state.SetLabel(fmt::format("{:.2f} ms on two threads, target {} ms: {}", wall, target_ms,
                               wall <= target_ms ? "ok" : "MISSED"));
}

void item_buffer(benchmark::State& state) {
    against_bare_pass(
        state,
        [&] {
            return all_pixels(
                ItemHistogram(picture().view(), ItemLayout::of_objects(objects, int(state.range(0)))));
        },
        10.0);
}
BENCHMARK(item_buffer)->Arg(0)->Arg(2)->Arg(4)->Arg(5)->UseManualTime()->Iterations(15);

void region_sets(benchmark::State& state) {
    against_bare_pass(
        state,
        [&] {
            return all_pixels(
                RegionQueries(picture().view(), picture().bounds, {.channels = int(state.range(0))}));
        },
        30.0);
}
BENCHMARK(region_sets)->Arg(4)->Arg(8)->UseManualTime()->Iterations(15);

void exact_counts(benchmark::State& state) {
    against_bare_pass(
        state, [] { return all_pixels(ExactCounts(picture().view(), objects)); }, 30.0);
}
BENCHMARK(exact_counts)->UseManualTime()->Iterations(15);

}  // namespace
}  // namespace mote::benchmarks
