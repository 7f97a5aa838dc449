// Block-wise feature regression of a frame of 1280 x 720, beside one plain pass over the same buffers: every
// feature and colour is read once, a colour written. Both on one thread. And the seconds of a whole frame of
// a sequence on all cores: accumulation before and after, reprojection, albedo.
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>

#include "core/math/random.h"
#include "experiments/benchmarks/turns.h"
#include "screenspace/denoising/sequence_denoiser.h"

namespace mote::benchmarks {
namespace {

using namespace core;
using namespace screenspace;

constexpr int width = 1280, height = 720;
constexpr std::size_t pixels = std::size_t(width) * height;

/// Hills, seen straight on, with noise for light.
struct Hills {
    std::vector<std::vector<float>> planes{6, std::vector<float>(pixels)};
    std::vector<Vec3> position{pixels}, normal{pixels};
    std::vector<Rgb> albedo{pixels}, colour{pixels};

    Hills() {
        Rng rng(1);
        for (std::size_t p = 0; p < pixels; ++p) {
            const float x = 0.01f * float(p % width), y = 0.01f * float(p / width);
            position[p] = Vec3(x, y, std::sin(x) * std::sin(2.0f * y));
            normal[p] = glm::normalize(
                Vec3(-std::cos(x) * std::sin(2.0f * y), -2.0f * std::sin(x) * std::cos(2.0f * y), 1.0f));
            albedo[p] = Rgb(0.5f + 0.4f * std::sin(20.0f * x));
            colour[p] = albedo[p] * Rgb(2.0f * rng.next_float());
            for (int c = 0; c < 3; ++c) {
                planes[std::size_t(c)][p] = normal[p][c];
                planes[std::size_t(c) + 3][p] = position[p][c];
            }
        }
    }
    std::vector<FeaturePlane> features() const {
        std::vector<FeaturePlane> result;
        for (std::size_t i = 0; i < planes.size(); ++i) result.push_back({planes[i], i >= 3});
        return result;
    }
};

double regress(const Hills& hills) {
    RegressionSettings settings;
    settings.overlapping = false, settings.offset = block_offset(1);
    const auto features = hills.features();
    return seconds_of(
        [&] { benchmark::DoNotOptimize(block_regression(width, height, features, hills.colour, settings)); });
}

double plain_pass(const Hills& hills) {
    return seconds_of([&] {
        std::vector<Rgb> result(pixels);
        for (std::size_t p = 0; p < pixels; ++p) {
            const auto& f = hills.planes;
            const float sum = f[0][p] + f[1][p] + f[2][p] + f[3][p] + f[4][p] + f[5][p];
            result[p] = hills.colour[p] * sum;
        }
        benchmark::DoNotOptimize(result.data());
        benchmark::ClobberMemory();
    });
}

void bmfr_against_a_plain_pass(benchmark::State& state) {
    const Hills hills;
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    take_turns(
        state, no_target, double(pixels), [&] { return regress(hills); }, [&] { return plain_pass(hills); });
}
BENCHMARK(bmfr_against_a_plain_pass)->UseManualTime()->Iterations(7)->Unit(benchmark::kMillisecond);

/// Processor seconds of all threads, and those of the clock.
void bmfr_frame_on_all_cores(benchmark::State& state) {
    const Hills hills;
    DenoiserSettings settings;
    settings.regression.overlapping = false;
    SequenceDenoiser denoiser(settings);
    DenoiserFrame frame;
    frame.features = {width, height, hills.position, hills.normal, {}, {}, {}};
    frame.layers.push_back({hills.colour, hills.albedo, hills.features()});
    denoiser.add(frame);
    for (auto _ : state) benchmark::DoNotOptimize(denoiser.add(frame));
}
BENCHMARK(bmfr_frame_on_all_cores)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(7)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
