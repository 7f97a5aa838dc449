#include "integrators/path_tracing/guided_paths.h"

#include <bit>

#include "integrators/path_tracing/guiding_trials.h"
#include "integrators/path_tracing/path_recorder.h"

namespace mote::integrators {

using namespace core;
using lights::GuidingSample, lights::LearnedGuide;

namespace {

void append(std::vector<GuidingSample>& to, const std::vector<GuidingSample>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// Empties the parts.
GuideSamples joined(std::vector<GuideSamples>& parts) {
    GuideSamples all;
    for (GuideSamples& part : parts)
        append(all.surfaces, part.surfaces), append(all.media, part.media), part = {};
    return all;
}

template <bool Media>
GuideSamples trace_training_pass(const Scene& scene, const RenderOptions& options,
                                 const PathSettings& settings, const PassOfPaths& pass,
                                 const LearnedGuide& guide, SharedCounters& counters) {
    std::vector<GuideSamples> chunks(pass.chunks());
    trace_pass<Media>(scene, options, settings, pass, guide, counters,
                      [&](std::size_t chunk, std::size_t, EyePacket<Media>& packet) {
                          PathRecorder<Media> recorder;
                          trace_paths(scene, settings, packet, &recorder);
                          recorder.finish(packet, chunks[chunk].surfaces, chunks[chunk].media);
                      });
    return joined(chunks);
}

}  // namespace

template <bool Media>
GuideTraining<Media>::GuideTraining(const Scene& scene, const RenderOptions& options,
                                    const PathSettings& settings, double ray_work, SharedCounters& counters)
    : scene_(scene), options_(options), settings_(settings), counters_(counters) {
    options_.memory.require(double(settings_.guiding.paths) * double(PathRecorder<Media>::max_records) *
                                sizeof(GuidingSample) * 2.0,
                            "the samples of a training pass");
    train();
    if (settings_.guiding.mode == Guiding::automatic &&
        !GuidingTrials<Media>(scene_, options_, settings_, ray_work, counters_).pays(*guide_))
        guide_.reset();
}

template <bool Media>
void GuideTraining<Media>::train() {
    const GuidingSettings& guiding = settings_.guiding;
    guide_ = std::make_unique<LearnedGuide>(
        lights::GuidingField::Settings{guiding.leaf_samples, guiding.memory * 1048576.0}, Media,
        options_.memory);
    for (std::uint32_t i = 0; i < std::uint32_t(std::min(first_training_passes, guiding.passes)); ++i) {
        const PassOfPaths pass{i, i, std::size_t(guiding.paths)};
        GuideSamples samples =
            trace_training_pass<Media>(scene_, options_, settings_, pass, *guide_, counters_);
        learn_from(i, samples);
    }
}

template <bool Media>
void GuideTraining<Media>::learn_from(std::uint32_t pass, GuideSamples& samples) {
    // Passes 1, 2, 4, ...: the later ones are guided better, so what was learned before counts half.
    if (std::has_single_bit(pass + 1) && pass > 0) guide_->surfaces().scale(0.5), guide_->media().scale(0.5);
    guide_->surfaces().add(samples.surfaces), guide_->media().add(samples.media);
}

template <bool Media>
std::uint32_t GuideTraining<Media>::picture_passes() const {
    return guide_ ? std::uint32_t(std::max(0, settings_.guiding.passes - first_training_passes)) : 0;
}

template <bool Media>
bool GuideTraining<Media>::records(std::uint32_t pass, std::size_t task) const {
    const double share = double(settings_.guiding.paths) / (double(options_.width) * double(options_.height));
    return double(to_unit_float(std::uint32_t(hash_keys(options_.seed, pass, task, 0x7265636fu)))) < share;
}

template <bool Media>
void GuideTraining<Media>::learn(std::vector<GuideSamples>& tasks) {
    GuideSamples samples = joined(tasks);
    learn_from(std::uint32_t(first_training_passes) + learned_++, samples);
}

template <bool Media>
void GuideTraining<Media>::restart() {
    if (learned_ == 0) return;
    learned_ = 0;
    train();
}

template class GuideTraining<true>;
template class GuideTraining<false>;

}  // namespace mote::integrators
