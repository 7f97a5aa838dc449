#include "screenspace/layer_filter/shrinkage.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "core/math/vectorize.h"
#include "screenspace/layer_filter/level_kernel.h"

namespace mote::screenspace {

using namespace core;

namespace {

constexpr std::size_t colours = FilterChannels::colours, channel_count = FilterChannels::count;
constexpr std::uint64_t probe_stream = 0x70726f6265ull;

/// Calls body(y, x0, x1) for all pieces of rows, in parallel.
template <typename Body>
void for_each_piece(const FilterPlanes& p, CancelToken cancelled, const Body& body) {
    tbb::parallel_for(0, p.height, [&](int y) {
        if (cancelled.requested()) return;
        for (int x = 0; x < p.width; x += LevelKernel::max_pixels)
            body(y, x, std::min(p.width, x + LevelKernel::max_pixels));
    });
    cancelled.check();
}

/// Result of one level: the coarser channels, and the energies of the details between.
struct Level {
    FilterChannels coarse;
    std::vector<float> energy, noise;  ///< mean over colours, over probes
    explicit Level(std::size_t pixels) : coarse(pixels), energy(pixels), noise(pixels) {}
};

void take_apart(const FilterPlanes& p, int step, const FilterChannels& fine, Level& level,
                CancelToken cancelled) {
    for_each_piece(p, cancelled, [&](int y, int x0, int x1) {
        LevelKernel kernel(p, step, y, x0, x1);
        kernel.make_linear();
        const std::size_t at = p.index(x0, y);
        float* energies[2] = {level.energy.data() + at, level.noise.data() + at};
        for (std::size_t c = 0; c < channel_count; ++c) {
            float* next = level.coarse.planes[c].data() + at;
            kernel.regress(fine.planes[c], next);
            const float* now = fine.planes[c].data() + at;
            const bool probe = c >= colours;
            float* energy = energies[probe];
            const float per_plane = 1.0f / float(probe ? FilterChannels::probes : colours);
            for (int i = 0; i < x1 - x0; ++i) energy[i] += per_plane * sqr(now[i] - next[i]);
        }
    });
}

/// k of Eq. (2). Energies are averages over the taps, some m independent values where noise is even, but one
/// or two where outliers have most of it: then a few of them in one pixel pass for a detail, and stand in the
/// picture as a dot. With w the weights of the taps, 1 / m = sum w^2 N^2 / (sum w N)^2, which is nearly w_0
/// sum w N^2 / (sum w N)^2 where noise is that of the pixel itself; there k is three times what it is where
/// noise is even.
float needed_ratio(float confidence, float noise, float squared_noise) {
    constexpr float centre = 36.0f / 256.0f;                                 // w_0
    const float concentration = squared_noise / max_of(sqr(noise), 1e-36f);  // denormal numbers are 0
    return confidence * (1.0f + 2.0f * centre * (max_of(1.0f, concentration) - 1.0f));
}

/// Over how many independent values the energies are averaged: one over the sum of the squared weights of the
/// 5 x 5 taps.
constexpr float averaged_values = (256.0f / 70.0f) * (256.0f / 70.0f);

/// Where noise is above its expectation by chance, the gain is higher, too, so that more of it is kept than
/// the gains as they are would keep of other noise. With d = (1 - k N m / |d|^2) d over m independent values,
/// the factor's derivative adds 2 (1 - g) to the gain along d itself, so that the variance that is left is N
/// (g^2 + ((2 - g)^2 - g^2) / m) = N (g^2 + 4 (1 - g) / m).
float variance_of_gain(float change) { return change > -1.0f ? -4.0f * change / averaged_values : 0.0f; }

void add_shrunk(const FilterPlanes& p, int step, const FilterChannels& fine, const Level& level,
                float confidence, ShrunkDetails& sum, CancelToken cancelled) {
    std::vector<float> squared(level.noise.size());
    std::transform(level.noise.begin(), level.noise.end(), squared.begin(), [](float n) {
        return sqr(
            min_of(n, 1e18f));  // of what is all but black the noise can be so much; infinity times 0 is NaN
    });
    for_each_piece(p, cancelled, [&](int y, int x0, int x1) {
        const LevelKernel kernel(p, step, y, x0, x1);
        float energy[LevelKernel::max_pixels], noise[LevelKernel::max_pixels];
        float squared_noise[LevelKernel::max_pixels];
        kernel.average(level.energy, energy), kernel.average(level.noise, noise);
        kernel.average(squared, squared_noise);
        float change[LevelKernel::max_pixels];  // g - 1, Eq. (2)
        for (int i = 0; i < x1 - x0; ++i)
            change[i] = noise[i] > 0.0f ? -min_of(1.0f, needed_ratio(confidence, noise[i], squared_noise[i]) *
                                                            noise[i] / max_of(energy[i], 1e-38f))
                                        : 0.0f;
        const std::size_t at = p.index(x0, y);
        for (int i = 0; i < x1 - x0; ++i)
            sum.of_gains[at + std::size_t(i)] += noise[i] * variance_of_gain(change[i]);
        for (std::size_t c = 0; c < channel_count; ++c) {
            const float *now = fine.planes[c].data() + at, *next = level.coarse.planes[c].data() + at;
            float* out = sum.change.planes[c].data() + at;
            for (int i = 0; i < x1 - x0; ++i) out[i] += change[i] * (now[i] - next[i]);
        }
    });
}

}  // namespace

FilterChannels demodulated(const FilterFeatures& f, const FilterPlanes& p, const LayerToFilter& layer) {
    FilterChannels channels(f.pixels());
    tbb::parallel_for(std::size_t(0), f.pixels(), [&](std::size_t i) {
        if (!(p.weight[i] > 0.0f)) return;
        const Rgb m = modulation(f, layer.kind, i), y = layer.mean[i] / m;
        const float deviation = std::sqrt(max_of(0.0f, average(layer.variance[i] / (m * m))));
        for (int c = 0; c < int(colours); ++c) channels.planes[std::size_t(c)][i] = y[c];
        const std::uint64_t bits = hash_keys(probe_stream, i);
        for (std::size_t c = colours; c < channel_count; ++c)
            channels.planes[c][i] = bits >> (c + 7) & 1 ? deviation : -deviation;
    });
    return channels;
}

ShrunkDetails shrink_details(const FilterPlanes& p, FilterChannels channels,
                             const LayerFilterSettings& settings, CancelToken cancelled) {
    ShrunkDetails sum{FilterChannels(p.weight.size()), std::vector<float>(p.weight.size())};
    for (int l = 0; l < settings.levels; ++l) {
        Level level(p.weight.size());
        take_apart(p, 1 << l, channels, level, cancelled);
        add_shrunk(p, 1 << l, channels, level, settings.confidence, sum, cancelled);
        channels = std::move(level.coarse);
    }
    return sum;
}

std::vector<float> smoothed(const FilterPlanes& p, const std::vector<float>& values, CancelToken cancelled) {
    std::vector<float> result(values.size());
    for_each_piece(p, cancelled, [&](int y, int x0, int x1) {
        LevelKernel(p, 1, y, x0, x1).average(values, result.data() + p.index(x0, y));
    });
    return result;
}

}  // namespace mote::screenspace
