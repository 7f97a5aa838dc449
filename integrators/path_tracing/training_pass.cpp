#include "integrators/path_tracing/training_pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/render/render_driver.h"
#include "integrators/path_tracing/path_recorder.h"

namespace mote::integrators {

using namespace core;
using lights::GuidingSamples;

namespace {

constexpr std::uint32_t training_stream = 0x677569u;  // keeps training paths apart from those of the picture
constexpr std::size_t chunk_paths = 256;              ///< of a task, packet by packet

std::size_t chunks_of(const TrainingPass& pass) { return (pass.paths + chunk_paths - 1) / chunk_paths; }

}  // namespace

template <bool Media>
EyeRay TrainingPaths<Media>::eye_ray(const PixelFilter& filter, const TrainingPass& pass,
                                     std::size_t path) const {
    const std::size_t width = std::size_t(options_.width), pixels = width * std::size_t(options_.height);
    const float shift = to_unit_float(std::uint32_t(hash_keys(options_.seed, pass.layout, training_stream)));
    const double position = (double(path) + double(shift)) / double(pass.paths) * double(pixels);
    const std::size_t pixel = std::size_t(position) % pixels;
    const std::atomic<bool> never{false};
    Sampler sampler(options_.sampler, options_.seed, pass.index, path, training_stream);
    const Rng rng = sampler.make_rng();
    const auto [ray, film] = camera_ray(scene_.camera(), PassContext{pass.index, filter, never},
                                        int(pixel % width), int(pixel / width), sampler);
    return {ray, film, sampler, rng};
}

/// Traces the paths in parallel; trace(chunk, first path, packet) follows those of a packet that were
/// started.
template <bool Media>
template <typename Trace>
void TrainingPaths<Media>::trace(const TrainingPass& pass, const lights::ScatteringGuide& guide,
                                 CancelToken cancelled, SharedCounters& counters, const Trace& trace) const {
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    tbb::parallel_for(std::size_t(0), chunks_of(pass), [&](std::size_t chunk) {
        WalkContext walk;
        walk.cancelled = cancelled, walk.all_boundaries = settings_.equiangular != nullptr;
        const auto packet = std::make_unique<EyePacket<Media>>(
            scene_, EyePacketSettings{.limits = settings_.limits, .guide = guide}, walk);
        const std::size_t end = std::min(pass.paths, (chunk + 1) * chunk_paths);
        for (std::size_t first = chunk * chunk_paths; first < end; first += EyePacket<Media>::width) {
            for (int i = 0; i < EyePacket<Media>::width; ++i)
                if (const std::size_t path = first + std::size_t(i); path < end)
                    packet->start(i, eye_ray(*filter, pass, path));
                else
                    packet->stop(i);
            trace(chunk, first, *packet);
        }
        counters.add(walk.rays, walk.tracking);
    });
}

template <bool Media>
GuidingSamples TrainingPaths<Media>::record(const TrainingPass& pass, const lights::ScatteringGuide& guide,
                                            CancelToken cancelled, SharedCounters& counters) const {
    std::vector<GuidingSamples> chunks(chunks_of(pass));
    trace(pass, guide, cancelled, counters, [&](std::size_t chunk, std::size_t, EyePacket<Media>& packet) {
        PathRecorder<Media> recorder;
        trace_paths(scene_, settings_, packet, recorder);
        recorder.finish(packet, chunks[chunk]);
    });
    GuidingSamples all;
    for (GuidingSamples& chunk : chunks) all.append(chunk), chunk = {};
    return all;
}

template <bool Media>
std::vector<float> TrainingPaths<Media>::light(const TrainingPass& pass, const lights::ScatteringGuide& guide,
                                               CancelToken cancelled, SharedCounters& counters) const {
    std::vector<float> light(pass.paths);
    trace(pass, guide, cancelled, counters, [&](std::size_t, std::size_t first, EyePacket<Media>& packet) {
        trace_paths(scene_, settings_, packet);
        for (std::size_t i = 0; i < EyePacket<Media>::width && first + i < pass.paths; ++i)
            for (const Rgb& l : packet[int(i)].sum.light) light[first + i] += average(l);
    });
    return light;
}

template class TrainingPaths<true>;
template class TrainingPaths<false>;

}  // namespace mote::integrators
