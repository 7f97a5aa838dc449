#include "integrators/path_tracing/guided_paths.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "core/render/counted_work.h"
#include "core/render/render_driver.h"
#include "integrators/path_tracing/path_recorder.h"

namespace mote::integrators {

using namespace core;
using lights::GuidingSamples, lights::GuideParts, lights::LearnedGuide;

namespace {

constexpr std::uint32_t training_stream = 0x677569u;  // keeps training paths apart from those of the picture
constexpr std::size_t chunk_paths = 1024;             ///< of a task, packet by packet

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
GuidingSamples trace_training_pass(const Scene& scene, const RenderOptions& options,
                                   const PathSettings& settings, const PassOfPaths& pass,
                                   const LearnedGuide& guide, SharedCounters& counters) {
    std::vector<GuidingSamples> chunks(chunks_of(pass));
    trace_pass<Media>(scene, options, settings, pass, guide, counters,
                      [&](std::size_t chunk, std::size_t, EyePacket<Media>& packet) {
                          PathRecorder<Media> recorder;
                          trace_paths(scene, settings, packet, recorder);
                          recorder.finish(packet, chunks[chunk]);
                      });
    GuidingSamples all;
    for (GuidingSamples& chunk : chunks) all.append(chunk), chunk = {};
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

/// Variances of several kinds of paths over the squared mean around each path. That is taken from a run of
/// neighbouring paths: from those of a pixel alone, a bright one would hide itself.
std::vector<double> relative_variances(std::span<const Trials> kinds) {
    constexpr std::size_t run = 256;
    const std::size_t paths = kinds.front().front().size();
    std::vector<double> means, variances;  // of runs; of runs and kinds
    for (std::size_t first = 0; first < paths; first += run) {
        const std::size_t end = std::min(first + run, paths);
        double mean = 0.0;
        for (const Trials& trials : kinds) {
            double variance = 0.0;
            for (std::size_t i = first; i < end; ++i) {
                for (const auto& t : trials) mean += double(t[i]);
                variance += variance_of(trials, i);
            }
            variances.push_back(variance);
        }
        means.push_back(mean / (trial_passes * double(kinds.size() * (end - first))));
    }
    double whole = 0.0;
    for (const double mean : means) whole += mean / double(means.size());
    std::vector<double> sums(kinds.size());
    for (std::size_t r = 0; r < means.size(); ++r)
        for (std::size_t k = 0; k < kinds.size() && means[r] > 0.0; ++k)
            sums[k] += variances[r * kinds.size() + k] / (means[r] * means[r] + 0.01 * whole * whole);
    return sums;
}

/// All that a guide can decide in the scene. Light of media that glow is not sampled along whole segments.
template <bool Media>
GuideParts largest_parts(const Scene& scene, const GuidingSettings& settings) {
    if (!settings.vertices) return GuideParts::directions;
    if (!Media) return GuideParts::directions_and_ends;
    for (const auto& medium : scene.media())
        if (medium->traits().emissive) return GuideParts::directions_and_ends;
    return GuideParts::directions_and_vertices;
}

}  // namespace

template <bool Media>
bool choose_parts(const Scene& scene, const RenderOptions& options, const PathSettings& settings,
                  LearnedGuide& guide, double work, SharedCounters& counters) {
    const auto paths = std::size_t(std::max(16, settings.guiding.paths / 4));
    const std::uint32_t first = std::uint32_t(settings.guiding.passes);
    std::uint32_t begin = first;
    std::vector<Trials> kinds;
    std::vector<double> cost;  // of each kind
    const auto measure = [&](const lights::ScatteringGuide& of, double factor) {
        Trials& result = kinds.emplace_back();
        SharedCounters own;
        for (auto& light : result)
            light = trial_pass<Media>(scene, options, settings, {begin++, first, paths}, of, own);
        Statistics statistics;
        own.report(statistics, Media), counters.add(own);
        cost.push_back(counted_work(statistics) * factor);
    };
    std::vector<GuideParts> parts{GuideParts::directions, largest_parts<Media>(scene, settings.guiding)};
    if (parts[0] == parts[1]) parts.pop_back();
    measure(lights::no_guide(), 1.0);
    for (const GuideParts p : parts) guide.decide(p), measure(guide, work);
    std::vector<double> loss = relative_variances(kinds);
    for (std::size_t k = 0; k < loss.size(); ++k) loss[k] *= cost[k];
    const auto best = std::size_t(std::min_element(loss.begin(), loss.end()) - loss.begin());
    if (best > 0) guide.decide(parts[best - 1]);
    return best > 0;
}

template <bool Media>
std::unique_ptr<LearnedGuide> train_guide(const Scene& scene, const RenderOptions& options,
                                          const PathSettings& settings, SharedCounters& counters) {
    const GuidingSettings& guiding = settings.guiding;
    auto guide = std::make_unique<LearnedGuide>(
        lights::GuidingField::Settings{guiding.leaf_samples, guiding.memory * 1048576.0}, Media,
        options.memory);
    guide->decide(largest_parts<Media>(scene, guiding));
    options.memory.require(double(guiding.paths) * double(PathRecorder<Media>::max_bytes) * 2.0,
                           "the samples of a training pass");
    for (std::uint32_t i = 0; i < std::uint32_t(guiding.passes); ++i) {
        // Passes 1, 2, 4, ...: the later ones are guided better, so what was learned before counts half.
        if (std::has_single_bit(i + 1) && i > 0) guide->scale(0.5);
        const PassOfPaths pass{i, i, std::size_t(guiding.paths)};
        GuidingSamples samples = trace_training_pass<Media>(scene, options, settings, pass, *guide, counters);
        guide->add(samples);
    }
    return guide;
}

template bool choose_parts<true>(const Scene&, const RenderOptions&, const PathSettings&, LearnedGuide&,
                                 double, SharedCounters&);
template bool choose_parts<false>(const Scene&, const RenderOptions&, const PathSettings&, LearnedGuide&,
                                  double, SharedCounters&);
template std::unique_ptr<LearnedGuide> train_guide<true>(const Scene&, const RenderOptions&,
                                                         const PathSettings&, SharedCounters&);
template std::unique_ptr<LearnedGuide> train_guide<false>(const Scene&, const RenderOptions&,
                                                          const PathSettings&, SharedCounters&);

}  // namespace mote::integrators
