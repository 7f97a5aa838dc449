#include "integrators/path_tracing/guided_paths.h"

#include <bit>
#include <chrono>
#include <limits>

#include "core/render/counted_work.h"
#include "integrators/path_tracing/path_recorder.h"

namespace mote::integrators {

using namespace core;
using lights::GuideParts, lights::GuidingSamples, lights::LearnedGuide, lights::ScatteringGuide;

namespace {

/// Counted work of learning from a sample, all steps of expectation and maximisation [closest hits].
constexpr double sample_work = 0.1;
/// Work of the first training pass over that of its paths, before it was counted.
constexpr double first_work = 1.5;
/// Trials follow training passes 8, 16, 32, ...; training ends where unguided paths are still better after
/// so many.
constexpr int first_trial = 8, last_chance = 32;
/// Paths of a training pass over those of one of the trial_passes: a kind takes half as long.
constexpr int trial_part = 2 * int(trial_passes);

/// All that a guide can decide in the scene. Light of media that glow is not sampled along whole segments.
template <bool Media>
GuideParts largest_parts(const Scene& scene, const GuidingSettings& settings) {
    if (!Media || !settings.vertices || scene.media().empty()) return GuideParts::directions;
    for (const auto& medium : scene.media())
        if (medium->traits().emissive) return GuideParts::directions;
    return GuideParts::directions_and_vertices;
}

std::vector<GuideParts> parts_on_trial(GuideParts largest) {
    if (largest == GuideParts::directions) return {largest};
    return {GuideParts::directions, largest};
}

double samples_of(const GuidingSamples& s) {
    return double(s.surfaces.size() + s.media.size() + s.reflected_by_surfaces.size() +
                  s.reflected_by_media.size());
}

}  // namespace

template <bool Media>
TrainedGuides<Media>::TrainedGuides(const Scene& scene, const RenderOptions& options,
                                    const PathSettings& settings, double ray_work, SharedCounters& counters)
    : options_(options),
      guiding_(settings.guiding),
      paths_(scene, options, settings),
      largest_(largest_parts<Media>(scene, settings.guiding)),
      ray_work_(ray_work),
      counters_(counters),
      parts_(parts_on_trial(largest_)),
      trials_(parts_.size() + 1) {
    const double samples = double(guiding_.paths) * double(PathRecorder<Media>::max_bytes) * 2.0;
    options.memory.require(guiding_.memory * 1048576.0 + samples, "guided paths");
    restart();
}

template <bool Media>
void TrainedGuides<Media>::restart() {
    guide_ = std::make_unique<LearnedGuide>(
        lights::GuidingField::Settings{guiding_.leaf_samples, guiding_.memory * 1048576.0}, Media,
        options_.memory);
    guide_->decide(guiding_.mode == Guiding::on ? largest_ : GuideParts::directions);
    passes_ = 0, indices_ = 0, work_ = paths_work_ = 0.0, guides_ = given_up_ = false;
    trials_ = GuidingTrials(parts_.size() + 1);
}

/// Trials follow this training pass.
template <bool Media>
bool TrainedGuides<Media>::trial_follows(int passes) const {
    return guiding_.mode == Guiding::automatic && passes >= first_trial &&
           std::has_single_bit(std::uint32_t(passes));
}

/// The budget of pass n is a share of the work of the n passes before, whose paths cost what those of the
/// training do. It grows with n: passes that were trained for one by one, or all at once, are as many.
template <bool Media>
bool TrainedGuides<Media>::budget_allows(std::uint32_t pass) const {
    if (given_up_ || passes_ >= guiding_.passes) return false;
    const double paths = guiding_.share * double(pass) * double(options_.width) * double(options_.height);
    if (passes_ == 0) return double(guiding_.paths) * first_work <= paths;
    const double next = trial_follows(passes_ + 1) ? 1.0 + 0.5 * double(trials_.kinds()) : 1.0;
    return work_ * (1.0 + next / double(passes_)) <= paths * work_of_path();
}

template <bool Media>
const ScatteringGuide& TrainedGuides<Media>::guide_of(std::uint32_t pass, CancelToken cancelled) {
    const auto start = std::chrono::steady_clock::now();
    if (pass < trained_for_) restart();
    trained_for_ = std::numeric_limits<std::uint32_t>::max();  // until all is done: it may be cancelled
    while (budget_allows(pass)) train(cancelled);
    trained_for_ = pass;
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return guides_ ? *guide_ : lights::no_guide();
}

/// Adds the rays to those of the render. Returns their work.
template <bool Media>
double TrainedGuides<Media>::count(const SharedCounters& own) {
    Statistics statistics;
    own.report(statistics, Media), counters_.add(own);
    return counted_work(statistics);
}

template <bool Media>
void TrainedGuides<Media>::train(CancelToken cancelled) {
    if (std::has_single_bit(std::uint32_t(passes_ + 1)) && passes_ > 0) guide_->scale(0.5);
    const TrainingPass pass{indices_, indices_, std::size_t(guiding_.paths)};
    SharedCounters own;
    GuidingSamples samples = paths_.record(pass, *guide_, cancelled, own);
    const double work = count(own);
    paths_work_ += work, work_ += work + sample_work * samples_of(samples);
    guide_->add(samples);
    ++passes_, ++indices_;
    if (guiding_.mode == Guiding::on) guides_ = true;
    if (trial_follows(passes_)) try_out(cancelled);
}

template <bool Media>
void TrainedGuides<Media>::try_out(CancelToken cancelled) {
    std::vector<Trial> kinds;
    std::vector<double> work;
    const auto layout = indices_;
    const auto measure = [&](const ScatteringGuide& guide, double factor) {
        SharedCounters own;
        for (auto& light : kinds.emplace_back())
            light = paths_.light({indices_++, layout, std::size_t(std::max(16, guiding_.paths / trial_part))},
                                 guide, cancelled, own);
        const double counted = count(own);
        work.push_back(counted * factor), work_ += counted;
    };
    measure(lights::no_guide(), 1.0);
    // Guided paths are charged what their training costs besides.
    for (const GuideParts p : parts_) guide_->decide(p), measure(*guide_, ray_work_ * (1.0 + guiding_.share));
    trials_.add(kinds, work);
    const std::size_t best = trials_.best();
    guides_ = best > 0;
    guide_->decide(guides_ ? parts_[best - 1] : GuideParts::directions);
    given_up_ = !guides_ && passes_ >= last_chance;
}

template <bool Media>
void TrainedGuides<Media>::add_statistics(Statistics& statistics) const {
    statistics.seconds["guiding"] += seconds_;
    statistics.values["guided"] = guides_ ? 1.0 : 0.0;
    statistics.values["guiding_passes"] = double(passes_);
    statistics.values["guiding_work"] = work_;
    statistics.values["guiding_leaves"] = double(guide_->leaves());
    statistics.values["guided_vertices"] = guides_ && guide_->candidates() > 0 ? 1.0 : 0.0;
    if (const double loss = trials_.loss(trials_.best()); loss > 0.0)
        statistics.values["guiding_gain"] = trials_.loss(0) / loss;
}

template <bool Media>
std::unique_ptr<PassGuides> make_pass_guides(const Scene& scene, const RenderOptions& options,
                                             const PathSettings& settings, double ray_work,
                                             SharedCounters& counters) {
    if (settings.guiding.mode == Guiding::off) return std::make_unique<NoPassGuides>();
    return std::make_unique<TrainedGuides<Media>>(scene, options, settings, ray_work, counters);
}

template class TrainedGuides<true>;
template class TrainedGuides<false>;
template std::unique_ptr<PassGuides> make_pass_guides<true>(const Scene&, const RenderOptions&,
                                                            const PathSettings&, double, SharedCounters&);
template std::unique_ptr<PassGuides> make_pass_guides<false>(const Scene&, const RenderOptions&,
                                                             const PathSettings&, double, SharedCounters&);

}  // namespace mote::integrators
