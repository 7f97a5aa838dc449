#include "integrators/path_tracing/guided_paths.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>

#include "core/render/counted_work.h"
#include "core/render/render_driver.h"
#include "integrators/path_tracing/path_recorder.h"

namespace mote::integrators {

using namespace core;
using lights::GuidingSample, lights::LearnedGuide;

namespace {

constexpr std::uint32_t training_stream = 0x677569u;  // keeps training paths apart from those of the picture
constexpr std::size_t chunk_paths = 1024;             ///< of a task, packet by packet

struct Samples {
    std::vector<GuidingSample> surfaces, media;
};

void append(std::vector<GuidingSample>& to, const std::vector<GuidingSample>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// Paths of a pass that is none of the picture.
struct PassOfPaths {
    std::uint32_t index;   ///< of its random numbers
    std::uint32_t layout;  ///< paths are spread evenly over the image, in another way for every layout
    std::size_t paths;
};

EyeRay eye_ray(const Scene& scene, const RenderOptions& options, const PixelFilter& filter,
               const PassOfPaths& pass, std::size_t path) {
    const std::size_t width = std::size_t(options.width), pixels = width * std::size_t(options.height);
    const float shift = to_unit_float(std::uint32_t(hash_keys(options.seed, pass.layout, training_stream)));
    const double position = (double(path) + double(shift)) / double(pass.paths) * double(pixels);
    const std::size_t pixel = std::size_t(position) % pixels;
    const std::atomic<bool> never{false};
    Sampler sampler(options.sampler, options.seed, pass.index, path, training_stream);
    const Rng rng = sampler.make_rng();
    const auto [ray, film] = camera_ray(scene.camera(), PassContext{pass.index, filter, never},
                                        int(pixel % width), int(pixel / width), sampler);
    return {ray, film, sampler, rng};
}

std::size_t chunks_of(const PassOfPaths& pass) { return (pass.paths + chunk_paths - 1) / chunk_paths; }

/// Traces the paths in parallel; trace(chunk, first path, packet) follows those of a packet that were
/// started.
template <bool Media, typename Trace>
void trace_pass(const Scene& scene, const RenderOptions& options, const PathSettings& settings,
                const PassOfPaths& pass, const lights::ScatteringGuide& guide, SharedCounters& counters,
                const Trace& trace) {
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    tbb::parallel_for(std::size_t(0), chunks_of(pass), [&](std::size_t chunk) {
        WalkContext walk;
        walk.cancelled = options.cancelled, walk.all_boundaries = settings.equiangular != nullptr;
        const auto packet = std::make_unique<EyePacket<Media>>(
            scene, EyePacketSettings{.limits = settings.limits, .guide = guide}, walk);
        const std::size_t end = std::min(pass.paths, (chunk + 1) * chunk_paths);
        for (std::size_t first = chunk * chunk_paths; first < end; first += EyePacket<Media>::width) {
            for (int i = 0; i < EyePacket<Media>::width; ++i)
                if (const std::size_t path = first + std::size_t(i); path < end)
                    packet->start(i, eye_ray(scene, options, *filter, pass, path));
                else
                    packet->stop(i);
            trace(chunk, first, *packet);
        }
        counters.add(walk.rays, walk.tracking);
    });
}

template <bool Media>
Samples trace_training_pass(const Scene& scene, const RenderOptions& options, const PathSettings& settings,
                            const PassOfPaths& pass, const LearnedGuide& guide, SharedCounters& counters) {
    std::vector<Samples> chunks(chunks_of(pass));
    trace_pass<Media>(scene, options, settings, pass, guide, counters,
                      [&](std::size_t chunk, std::size_t, EyePacket<Media>& packet) {
                          PathRecorder<Media> recorder;
                          trace_paths(scene, settings, packet, recorder);
                          recorder.finish(packet, chunks[chunk].surfaces, chunks[chunk].media);
                      });
    Samples all;
    for (Samples& chunk : chunks)
        append(all.surfaces, chunk.surfaces), append(all.media, chunk.media), chunk = {};
    return all;
}

/// Light of each path, averaged over channels.
template <bool Media>
std::vector<float> trial_pass(const Scene& scene, const RenderOptions& options, const PathSettings& settings,
                              const PassOfPaths& pass, const lights::ScatteringGuide& guide,
                              SharedCounters& counters) {
    std::vector<float> light(pass.paths);
    trace_pass<Media>(scene, options, settings, pass, guide, counters,
                      [&](std::size_t, std::size_t first, EyePacket<Media>& packet) {
                          trace_paths(scene, settings, packet);
                          for (std::size_t i = 0; i < EyePacket<Media>::width && first + i < pass.paths; ++i)
                              for (const Rgb& l : packet[int(i)].sum.light) light[first + i] += average(l);
                      });
    return light;
}

constexpr std::uint32_t trial_passes = 4;  ///< of each kind
using Trials = std::array<std::vector<float>, trial_passes>;

/// Variance of the trials of a pixel.
double variance_of(const Trials& trials, std::size_t pixel) {
    double sum = 0.0, squares = 0.0;
    for (const auto& t : trials) sum += double(t[pixel]), squares += sqr(t[pixel]);
    return std::max(0.0, squares - sum * sum / trial_passes) / (trial_passes - 1.0);
}

/// Variances of both kinds over the squared mean around each path. That is taken from a run of neighbouring
/// paths: from those of a pixel alone, a bright one would hide itself.
std::array<double, 2> relative_variances(const Trials& plain, const Trials& guided) {
    constexpr std::size_t run = 256;
    std::vector<std::array<double, 3>> runs;  // mean of both kinds, variances
    for (std::size_t first = 0; first < plain.front().size(); first += run) {
        const std::size_t end = std::min(first + run, plain.front().size());
        auto& [mean, without, with] = runs.emplace_back();
        for (std::size_t i = first; i < end; ++i) {
            for (std::uint32_t k = 0; k < trial_passes; ++k)
                mean += double(plain[k][i]) + double(guided[k][i]);
            without += variance_of(plain, i), with += variance_of(guided, i);
        }
        mean /= 2.0 * trial_passes * double(end - first);
    }
    double whole = 0.0;
    for (const auto& r : runs) whole += r[0] / double(runs.size());
    std::array<double, 2> sums{};
    for (const auto& [mean, without, with] : runs) {
        if (!(mean > 0.0)) continue;
        const double weight = 1.0 / (mean * mean + 0.01 * whole * whole);
        sums[0] += weight * without, sums[1] += weight * with;
    }
    return sums;
}

}  // namespace

template <bool Media>
bool guide_pays(const Scene& scene, const RenderOptions& options, const PathSettings& settings,
                const lights::ScatteringGuide& guide, double work, SharedCounters& counters) {
    const auto paths = std::size_t(std::max(16, settings.guiding.paths / 4));
    const std::uint32_t first = std::uint32_t(settings.guiding.passes);
    const auto trials = [&](const lights::ScatteringGuide& of, std::uint32_t begin, double& spent) {
        Trials result;
        SharedCounters own;
        for (std::uint32_t k = 0; k < trial_passes; ++k)
            result[k] = trial_pass<Media>(scene, options, settings, {begin + k, first, paths}, of, own);
        Statistics statistics;
        own.report(statistics, Media), counters.add(own);
        spent = counted_work(statistics);
        return result;
    };
    double plain_work = 0.0, guided_work = 0.0;
    const Trials plain = trials(lights::no_guide(), first, plain_work);
    const Trials guided = trials(guide, first + trial_passes, guided_work);
    const auto [without, with] = relative_variances(plain, guided);
    return with * guided_work * work < without * plain_work;
}

template <bool Media>
std::unique_ptr<LearnedGuide> train_guide(const Scene& scene, const RenderOptions& options,
                                          const PathSettings& settings, SharedCounters& counters) {
    const GuidingSettings& guiding = settings.guiding;
    auto guide = std::make_unique<LearnedGuide>(
        lights::GuidingField::Settings{guiding.leaf_samples, guiding.memory * 1048576.0}, Media,
        options.memory);
    options.memory.require(
        double(guiding.paths) * double(PathRecorder<Media>::max_records) * sizeof(GuidingSample) * 2.0,
        "the samples of a training pass");
    for (std::uint32_t i = 0; i < std::uint32_t(guiding.passes); ++i) {
        // Passes 1, 2, 4, ...: the later ones are guided better, so what was learned before counts half.
        if (std::has_single_bit(i + 1) && i > 0) guide->surfaces().scale(0.5), guide->media().scale(0.5);
        const PassOfPaths pass{i, i, std::size_t(guiding.paths)};
        Samples samples = trace_training_pass<Media>(scene, options, settings, pass, *guide, counters);
        guide->surfaces().add(samples.surfaces), guide->media().add(samples.media);
    }
    return guide;
}

template bool guide_pays<true>(const Scene&, const RenderOptions&, const PathSettings&,
                               const lights::ScatteringGuide&, double, SharedCounters&);
template bool guide_pays<false>(const Scene&, const RenderOptions&, const PathSettings&,
                                const lights::ScatteringGuide&, double, SharedCounters&);
template std::unique_ptr<LearnedGuide> train_guide<true>(const Scene&, const RenderOptions&,
                                                         const PathSettings&, SharedCounters&);
template std::unique_ptr<LearnedGuide> train_guide<false>(const Scene&, const RenderOptions&,
                                                          const PathSettings&, SharedCounters&);

}  // namespace mote::integrators
