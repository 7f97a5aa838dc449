#include "integrators/path_tracing/guided_paths.h"

#include <bit>

#include "integrators/path_tracing/path_recorder.h"

namespace mote::integrators {

using namespace core;
using lights::GuideParts, lights::GuidingSamples, lights::LearnedGuide;

namespace {

/// Variance times work, over that of unguided paths, from which a guide that continues to learn may still
/// pay.
constexpr double promising = 1.25;

/// Empties the parts.
GuidingSamples joined(std::vector<GuidingSamples>& parts) {
    GuidingSamples all;
    for (GuidingSamples& part : parts) all.append(part), part = {};
    return all;
}

/// All that a guide can decide in the scene. Light of media that glow is not sampled along whole segments.
template <bool Media>
GuideParts largest_parts_in(const Scene& scene, Guiding mode) {
    const auto glows = [](const auto& medium) { return medium->traits().emissive; };
    return !Media || mode == Guiding::directions || std::ranges::any_of(scene.media(), glows)
               ? GuideParts::directions
               : GuideParts::directions_and_vertices;
}

template <bool Media>
GuidingSamples trace_training_pass(const Scene& scene, const RenderOptions& options,
                                   const PathSettings& settings, const PassOfPaths& pass,
                                   const LearnedGuide& guide, GuideParts largest, SharedCounters& counters) {
    std::vector<GuidingSamples> chunks(pass.chunks());
    trace_pass<Media>(scene, options, settings, pass, guide, counters,
                      [&](std::size_t chunk, std::size_t, EyePacket<Media>& packet) {
                          PathRecorder<Media> recorder(largest);
                          trace_paths(scene, settings, packet, &recorder);
                          recorder.finish(packet, chunks[chunk]);
                      });
    return joined(chunks);
}

}  // namespace

template <bool Media>
GuideTraining<Media>::GuideTraining(const Scene& scene, const RenderOptions& options,
                                    const PathSettings& settings, double ray_work, SharedCounters& counters)
    : scene_(scene),
      options_(options),
      settings_(settings),
      counters_(counters),
      largest_parts_(largest_parts_in<Media>(scene, settings.guiding.mode)) {
    options_.memory.require(double(settings_.guiding.paths) * double(PathRecorder<Media>::max_bytes) * 2.0,
                            "the samples of a training pass");
    first_parts_ = largest_parts_;
    train();
    const int later = std::max(0, settings_.guiding.passes - first_training_passes);
    if (settings_.guiding.mode == Guiding::automatic) {
        trials_.emplace(scene_, options_, settings_, ray_work, counters_);
        decide(first_parts_ = trials_->best_of(*guide_, largest_parts_, later > 0 ? promising : 1.0));
    }
    if (first_parts_) picture_passes_ = std::uint32_t(later);
}

template <bool Media>
void GuideTraining<Media>::decide(const std::optional<GuideParts>& parts) {
    parts_ = parts;
    if (parts) guide_->decide(*parts);
}

template <bool Media>
void GuideTraining<Media>::train() {
    const GuidingSettings& guiding = settings_.guiding;
    guide_ = std::make_unique<LearnedGuide>(
        lights::GuidingField::Settings{guiding.leaf_samples, guiding.memory * 1048576.0}, Media,
        largest_parts_, options_.memory);
    for (std::uint32_t i = 0; i < std::uint32_t(std::min(first_training_passes, guiding.passes)); ++i) {
        const PassOfPaths pass{i, i, std::size_t(guiding.paths)};
        GuidingSamples samples =
            trace_training_pass<Media>(scene_, options_, settings_, pass, *guide_, largest_parts_, counters_);
        learn_from(i, samples);
    }
    decide(first_parts_);
}

template <bool Media>
void GuideTraining<Media>::learn_from(std::uint32_t pass, GuidingSamples& samples) {
    // Passes 1, 2, 4, ...: the later ones are guided better, so what was learned before counts half.
    if (std::has_single_bit(pass + 1) && pass > 0) guide_->scale(0.5);
    guide_->add(samples);
}

template <bool Media>
bool GuideTraining<Media>::records(std::uint32_t pass, std::size_t task) const {
    const double share = double(settings_.guiding.paths) / (double(options_.width) * double(options_.height));
    return double(to_unit_float(std::uint32_t(hash_keys(options_.seed, pass, task, 0x7265636fu)))) < share;
}

template <bool Media>
void GuideTraining<Media>::learn(std::vector<GuidingSamples>& tasks) {
    GuidingSamples samples = joined(tasks);
    learn_from(std::uint32_t(first_training_passes) + learned_++, samples);
    if (trials_ && learned_ == picture_passes_) decide(trials_->best_of(*guide_, largest_parts_, 1.0));
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
