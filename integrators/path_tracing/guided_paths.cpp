#include "integrators/path_tracing/guided_paths.h"

#include <tbb/parallel_for.h>

#include <bit>

#include "core/render/render_driver.h"
#include "integrators/path_tracing/path_recorder.h"

namespace mote::integrators {

using namespace core;
using lights::GuidingSample, lights::LearnedGuide;

namespace {

constexpr std::uint32_t training_stream = 0x677569u;  // keeps training paths apart from those of the picture
constexpr std::size_t chunk_paths = 1024;             ///< a task's, as many packets

struct Samples {
    std::vector<GuidingSample> surfaces, media;
};

void append(std::vector<GuidingSample>& to, const std::vector<GuidingSample>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// The eye ray of a training path: paths are spread evenly over the image, another way in every pass.
EyeRay training_ray(const Scene& scene, const RenderOptions& options, const PassContext& pass, std::size_t path,
                    std::size_t paths) {
    const std::size_t pixels = std::size_t(options.width) * std::size_t(options.height);
    const float shift = to_unit_float(std::uint32_t(hash_keys(options.seed, pass.index, training_stream)));
    const auto pixel =
        std::size_t((double(path) + double(shift)) / double(paths) * double(pixels)) % pixels;
    const int x = int(pixel % std::size_t(options.width)), y = int(pixel / std::size_t(options.width));
    Sampler sampler(options.sampler, options.seed, pass.index, path, training_stream);
    const Rng rng = sampler.make_rng();
    const auto [ray, film] = camera_ray(scene.camera(), pass, x, y, sampler);
    return {ray, film, sampler, rng};
}

template <bool Media>
Samples trace_training_pass(const Scene& scene, const RenderOptions& options, const PathSettings& settings,
                            const PassContext& pass, const LearnedGuide& guide, SharedCounters& counters) {
    const auto paths = std::size_t(settings.guiding.paths);
    std::vector<Samples> chunks((paths + chunk_paths - 1) / chunk_paths);
    tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t c) {
        WalkContext walk;
        walk.cancelled = options.cancelled, walk.all_boundaries = settings.equiangular != nullptr;
        auto packet = std::make_unique<EyePacket<Media>>(
            scene, EyePacketSettings{.limits = settings.limits, .guide = guide}, walk);
        PathRecorder<Media> recorder;
        const std::size_t end = std::min(paths, (c + 1) * chunk_paths);
        for (std::size_t first = c * chunk_paths; first < end; first += EyePacket<Media>::width) {
            for (int i = 0; i < EyePacket<Media>::width; ++i)
                if (const std::size_t path = first + std::size_t(i); path < end)
                    packet->start(i, training_ray(scene, options, pass, path, paths));
                else
                    packet->stop(i);
            trace_paths(scene, settings, *packet, &recorder);
            recorder.finish(*packet, chunks[c].surfaces, chunks[c].media);
        }
        counters.add(walk.rays, walk.tracking);
    });
    Samples all;
    for (Samples& chunk : chunks) append(all.surfaces, chunk.surfaces), append(all.media, chunk.media), chunk = {};
    return all;
}

}  // namespace

template <bool Media>
std::unique_ptr<LearnedGuide> train_guide(const Scene& scene, const RenderOptions& options,
                                          const PathSettings& settings, SharedCounters& counters) {
    const GuidingSettings& guiding = settings.guiding;
    auto guide = std::make_unique<LearnedGuide>(
        lights::GuidingField::Settings{guiding.leaf_samples, guiding.memory * 1048576.0}, Media, options.memory);
    options.memory.require(double(guiding.paths) * double(PathRecorder<Media>::max_records) * sizeof(GuidingSample) *
                               2.0,
                           "the samples of a training pass");
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> never{false};
    for (std::uint32_t i = 0; i < std::uint32_t(guiding.passes); ++i) {
        // Passes 1, 2, 4, ...: the later ones are guided better, so what was learned before counts half.
        if (std::has_single_bit(i + 1) && i > 0) guide->surfaces().scale(0.5), guide->media().scale(0.5);
        const PassContext pass{i, *filter, never};
        Samples samples = trace_training_pass<Media>(scene, options, settings, pass, *guide, counters);
        guide->surfaces().add(samples.surfaces), guide->media().add(samples.media);
    }
    return guide;
}

template std::unique_ptr<LearnedGuide> train_guide<true>(const Scene&, const RenderOptions&, const PathSettings&,
                                                         SharedCounters&);
template std::unique_ptr<LearnedGuide> train_guide<false>(const Scene&, const RenderOptions&, const PathSettings&,
                                                          SharedCounters&);

}  // namespace mote::integrators
