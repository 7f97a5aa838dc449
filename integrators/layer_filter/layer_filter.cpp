#include "integrators/layer_filter/layer_filter.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "core/render/cpu_clock.h"
#include "core/render/pass_runner.h"
#include "integrators/layer_filter/filtered_sum.h"
#include "screenspace/layer_filter/oidn_features.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Features that are found quickly.
FeatureSettings rough(const FeatureSettings& s) { return {std::min(s.samples, 4), 4.0f * s.voxels}; }

/// Time to find full features over that of rough ones (3 to 4.5), runs that denoise them, and time of those
/// of quarters over full ones (1 to 1.5).
constexpr double full_per_rough = 4.0, runs_of_features = 3.0, quarters_per_full = 1.4;
constexpr double runs_of_fine = 4.0;  ///< time of a layer's quarters over that of its pixels

screenspace::LayerToFilter to_filter(const ChosenLayer& choice, const LayerOfPasses& layer) {
    return {layer.mean, layer.variance, choice.kind};
}

LayerOfPasses of_half(const Film& film, std::size_t layer, int half) {
    return {film.half_mean(layer, half), film.half_variance_of_mean(layer, half)};
}

}  // namespace

const ParameterList<LayerFilterParameters>& layer_filter_rows() {
    using S = LayerFilterParameters;
    using Filter = screenspace::LayerFilterSettings;
    static const ParameterList<S> list{
        within(&S::filter,
               row("filter_levels", &Filter::levels, between(1, 12),
                   "Levels of details that the filter separates: pixels up to 2^(levels + 1) away are "
                   "averaged."),
               row("filter_confidence", &Filter::confidence, between(0, 1e6),
                   "A detail is kept if its energy is so many times that of the noise; 0 filters nothing.")),
        within(&S::features, row("filter_samples", &FeatureSettings::samples, between(1, 256),
                                 "Eye rays a pixel that find edges, in addition to those of the passes."))};
    return list;
}

LayerFilter::LayerFilter(const Scene& scene, const RenderOptions& options, const FeatureSettings& features,
                         std::vector<Choice> layers, std::shared_ptr<const screenspace::OidnLibrary> library,
                         MakeFilter make)
    : scene_(scene),
      options_(options),
      feature_settings_(features),
      layers_(std::move(layers)),
      library_(std::move(library)),
      make_(std::move(make)) {}

LayerFilter::LayerFilter(const Scene& scene, const RenderOptions& options,
                         const LayerFilterParameters& parameters, std::vector<Choice> layers)
    : LayerFilter(scene, options, parameters.features, std::move(layers), nullptr,
                  [settings = parameters.filter](const screenspace::FilterFeatures& features,
                                                 screenspace::FilterQuality) {
                      return screenspace::make_own_filter(features, settings);
                  }) {}

LayerFilter::LayerFilter(const Scene& scene, const RenderOptions& options, const FeatureSettings& features,
                         std::shared_ptr<const screenspace::OidnLibrary> library, std::vector<Choice> layers)
    : LayerFilter(scene, options, features, std::move(layers), library,
                  [library](const screenspace::FilterFeatures& found, screenspace::FilterQuality quality) {
                      return screenspace::make_oidn_filter(found, library, quality);
                  }) {}

void LayerFilter::find_features(const FilterPlan& now, CancelToken cancelled) {
    const bool full = now.full_features;
    const auto quality = full ? screenspace::FilterQuality::full : screenspace::FilterQuality::preview;
    if (filter_ && quality == found_quality_) return;
    options_.cancelled = cancelled;
    feature_seconds_ += std::exchange(last_feature_seconds_, 0.0);
    const Stopwatch stopwatch(last_feature_seconds_);
    filter_.reset();
    features_ = std::make_unique<screenspace::FilterFeatures>(
        find_filter_features(scene_, options_, full ? feature_settings_ : rough(feature_settings_)));
    filter_ = make_(*features_, quality);
    found_quality_ = quality;
}

bool LayerFilter::has_halves(const Film& film) const {
    return !layers_.empty() && std::ranges::all_of(layers_, [&](const Choice& choice) {
        const std::size_t part = film.layers()[choice.layer].part;
        return film.has_halves(choice.layer) && film.half_passes(part, 0) >= 2 &&
               film.half_passes(part, 1) >= 2;
    });
}

void LayerFilter::apply_to_halves(Film& film, const Choice& choice, CancelToken cancelled) {
    std::array<std::vector<Rgb>, 2> shown;
    for (const int half : {0, 1}) {
        const LayerOfPasses layer = of_half(film, choice.layer, half);
        shown[std::size_t(half)] = filter_->filtered(to_filter(choice, layer), cancelled).mean;
    }
    film.set_halves(choice.layer, std::move(shown));
}

void LayerFilter::apply(Film& film, CancelToken cancelled) {
    for (const Choice& choice : layers_)
        if (!film.has_squares(choice.layer))
            throw std::invalid_argument("a filtered layer needs its squares");
    if (layers_.empty() || (!library_ && !film.has_passes(2))) return;
    variances_.clear();
    const FilterPlan now = plan(film);
    find_features(now, cancelled);
    find_noise_free(film);
    if (now.joins) {
        apply_to_sums(film, screenspace::FilterQuality::full, time_of_run(now), cancelled);
        return;
    }
    const bool halves = has_halves(film);
    find_quarters(now, cancelled);
    double seconds = 0.0;
    {
        const Stopwatch stopwatch(seconds);
        for (const Choice& choice : layers_) {
            if (halves)
                apply_to_halves(film, choice, cancelled);
            else if (now.is_fine(choice.layer))
                apply_to_fine(film, choice.layer, cancelled);
            else if (passes_of(film, choice.layer) > 0)
                apply_to_mean(film, choice, cancelled);
        }
    }
    filter_->release();
    if (fine_) fine_->release();
    filter_seconds_ += seconds;
    if (const double count = runs(film, now); count > 0.0)
        seconds_per_run_ = seconds / (count * time_of_run(now));
}

FilterPlan LayerFilter::plan(const Film& film, std::uint32_t more) const {
    if (!library_) return {};
    FilterPlan result = plan_filter(film, layers_, more);
    if (!keeps_features_) return result;
    result.full_features = result.full_features && has_full_features();
    if (!fine_) result.fine.clear();
    return result;
}

double LayerFilter::seconds_to_find_features(const FilterPlan& next) const {
    const bool finds_full = needs_full_features(next);
    const double full = finds_full
                            ? full_per_rough * last_feature_seconds_ + runs_of_features * seconds_per_run_
                            : last_feature_seconds_;
    return (finds_full ? full : 0.0) + (needs_quarters(next) ? quarters_per_full * full : 0.0);
}

double LayerFilter::seconds_to_apply(const Film& film) const {
    const FilterPlan next = plan(film, 1);
    return seconds_to_find_features(next) + seconds_per_run_ * time_of_run(next) * runs(film, next);
}

void LayerFilter::keep_features(const Film& film) {
    const FilterPlan now = plan(film);
    keeps_features_ = keeps_features_ || !(needs_full_features(now) || needs_quarters(now));
}

void LayerFilter::find_quarters(const FilterPlan& now, CancelToken cancelled) {
    if (!needs_quarters(now)) return;
    options_.cancelled = cancelled;
    const Stopwatch stopwatch(feature_seconds_);
    fine_ = std::make_unique<screenspace::FinePixels>(find_fine_features(scene_, options_, feature_settings_),
                                                      library_, film_filter(scene_));
}

void LayerFilter::apply_to_fine(Film& film, std::size_t layer, CancelToken cancelled) {
    cancelled.check();
    const LayerOfPasses coarse = of_passes(film, layer);
    if (screenspace::is_zero(coarse.variance)) return;
    film.set_mean(layer, screenspace::mixed_with_mean(film.width(), film.height(),
                                                      fine_->denoised(film.fine_sums(layer).mean()),
                                                      {coarse.mean, coarse.variance}));
}

double LayerFilter::runs(const Film& film, const FilterPlan& of) const {
    const double halves = has_halves(film) ? 2.0 : 1.0;
    if (of.joins) return double(kinds_of(film, layers_).size()) * halves;
    double runs = 0.0;
    for (const Choice& choice : layers_)
        if (std::ranges::find(noise_free_, choice.layer) == noise_free_.end())
            runs += of.is_fine(choice.layer) ? runs_of_fine : halves;
    return runs;
}

double LayerFilter::time_of_run(const FilterPlan& of) const {
    // OpenImageDenoise has its larger network for features without noise alone.
    return filter_ && of.full_features ? filter_->full_per_preview() : 1.0;
}

void LayerFilter::find_noise_free(const Film& film) {
    noise_free_.clear();
    for (const Choice& choice : layers_) {
        if (passes_of(film, choice.layer) < 2) continue;
        if (screenspace::is_zero(film.layer_variance_of_mean(choice.layer)))
            noise_free_.push_back(choice.layer);
    }
}

void LayerFilter::apply_to_mean(Film& film, const Choice& choice, CancelToken cancelled) {
    const LayerOfPasses layer = of_passes(film, choice.layer);
    auto filtered = filter_->filtered(to_filter(choice, layer), cancelled);
    film.set_mean(choice.layer, filtered.mean, filtered.variance);
    variances_.push_back(std::move(filtered.variance));
}

LayerOfPasses LayerFilter::of_passes(Film& film, std::size_t layer) const {
    // Our own filter compares noise with details of several pixels, and is tested with that of independent
    // passes.
    return !library_ ? layer_of_passes(film, layer, 2, PassVariance::independent)
                     : layer_of_passes(film, layer, 4, PassVariance::points);
}

void LayerFilter::apply_to_sums(Film& film, screenspace::FilterQuality quality, double time_of_run,
                                CancelToken cancelled) {
    const std::vector<LayersOfKind> all = kinds_of(film, layers_);
    double seconds = 0.0;
    {
        const Stopwatch stopwatch(seconds);
        for (const LayersOfKind& kind : all) apply_to_sum(film, kind, quality, cancelled);
    }
    filter_->release();
    filter_seconds_ += seconds;
    const double count = double(all.size()) * (has_halves(film) ? 2.0 : 1.0);
    if (count > 0.0) seconds_per_run_ = seconds / (count * time_of_run);
}

bool LayerFilter::apply_for_preview(Film& film, CancelToken cancelled) {
    if (layers_.empty() || !library_) {
        apply(film, cancelled);
        return true;
    }
    find_features(plan(film), cancelled);
    find_noise_free(film);
    apply_to_sums(film, screenspace::FilterQuality::preview, 1.0, cancelled);
    return false;
}

void LayerFilter::apply_to_sum(Film& film, const LayersOfKind& kind, screenspace::FilterQuality quality,
                               CancelToken cancelled) {
    const std::vector<std::size_t>& layers = kind.layers;
    const auto shown = [&](const auto& layer_of) {
        std::vector<LayerOfPasses> all;
        for (const std::size_t layer : layers) all.push_back(layer_of(layer));
        return filtered_sum(*filter_, std::move(all), kind.kind, quality, cancelled);
    };
    if (!has_halves(film)) {
        const auto means = shown([&](std::size_t layer) { return of_passes(film, layer); });
        for (std::size_t i = 0; i < layers.size(); ++i) film.set_mean(layers[i], means[i]);
        return;
    }
    std::array<std::vector<std::vector<Rgb>>, 2> means;
    for (const int half : {0, 1})
        means[std::size_t(half)] = shown([&](std::size_t layer) { return of_half(film, layer, half); });
    for (std::size_t i = 0; i < layers.size(); ++i)
        film.set_halves(layers[i], {std::move(means[0][i]), std::move(means[1][i])});
}

void LayerFilter::add_statistics(Statistics& statistics) const {
    if (layers_.empty()) return;
    statistics.seconds["filter_features"] = feature_seconds();
    statistics.seconds["filter"] = filter_seconds_;
}

}  // namespace mote::integrators
