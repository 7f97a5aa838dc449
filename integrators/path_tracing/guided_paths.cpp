#include "integrators/path_tracing/guided_paths.h"

#include <bit>

#include "integrators/path_tracing/guiding_trials.h"
#include "integrators/path_tracing/path_recorder.h"

namespace mote::integrators {

using namespace core;
using lights::GuidingSample, lights::LearnedGuide;

namespace {

struct Samples {
    std::vector<GuidingSample> surfaces, media;
};

void append(std::vector<GuidingSample>& to, const std::vector<GuidingSample>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

template <bool Media>
Samples trace_training_pass(const Scene& scene, const RenderOptions& options, const PathSettings& settings,
                            const PassOfPaths& pass, const LearnedGuide& guide, SharedCounters& counters) {
    std::vector<Samples> chunks(pass.chunks());
    trace_pass<Media>(scene, options, settings, pass, guide, counters,
                      [&](std::size_t chunk, std::size_t, EyePacket<Media>& packet) {
                          PathRecorder<Media> recorder;
                          trace_paths(scene, settings, packet, &recorder);
                          recorder.finish(packet, chunks[chunk].surfaces, chunks[chunk].media);
                      });
    Samples all;
    for (Samples& chunk : chunks)
        append(all.surfaces, chunk.surfaces), append(all.media, chunk.media), chunk = {};
    return all;
}

/// A guide is tried out two doublings before its training ends, and then.
bool trial_follows(int passes, int all) { return passes == all || 4 * (passes + 1) == all + 1; }

}  // namespace

template <bool Media>
std::unique_ptr<LearnedGuide> train_guide(const Scene& scene, const RenderOptions& options,
                                          const PathSettings& settings, double ray_work,
                                          SharedCounters& counters) {
    const GuidingSettings& guiding = settings.guiding;
    auto guide = std::make_unique<LearnedGuide>(
        lights::GuidingField::Settings{guiding.leaf_samples, guiding.memory * 1048576.0}, Media,
        options.memory);
    options.memory.require(
        double(guiding.paths) * double(PathRecorder<Media>::max_records) * sizeof(GuidingSample) * 2.0,
        "the samples of a training pass");
    GuidingTrials<Media> trials(scene, options, settings, ray_work, counters);
    for (std::uint32_t i = 0; i < std::uint32_t(guiding.passes); ++i) {
        // Passes 1, 2, 4, ...: the later ones are guided better, so what was learned before counts half.
        if (std::has_single_bit(i + 1) && i > 0) guide->surfaces().scale(0.5), guide->media().scale(0.5);
        const PassOfPaths pass{i, i, std::size_t(guiding.paths)};
        Samples samples = trace_training_pass<Media>(scene, options, settings, pass, *guide, counters);
        guide->surfaces().add(samples.surfaces), guide->media().add(samples.media);
        if (guiding.mode == Guiding::automatic && trial_follows(int(i) + 1, guiding.passes) &&
            !trials.pays(*guide))
            return nullptr;
    }
    return guide;
}

template std::unique_ptr<LearnedGuide> train_guide<true>(const Scene&, const RenderOptions&,
                                                         const PathSettings&, double, SharedCounters&);
template std::unique_ptr<LearnedGuide> train_guide<false>(const Scene&, const RenderOptions&,
                                                          const PathSettings&, double, SharedCounters&);

}  // namespace mote::integrators
