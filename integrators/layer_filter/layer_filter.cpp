#include "integrators/layer_filter/layer_filter.h"

#include <stdexcept>

#include "core/render/cpu_clock.h"

namespace mote::integrators {

using namespace core;

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
                         std::vector<Choice> layers, bool has_variance, MakeFilter make)
    : scene_(scene),
      options_(options),
      feature_settings_(features),
      layers_(std::move(layers)),
      has_variance_(has_variance),
      make_(std::move(make)) {}

LayerFilter::LayerFilter(const Scene& scene, const RenderOptions& options,
                         const LayerFilterParameters& parameters, std::vector<Choice> layers)
    : LayerFilter(scene, options, parameters.features, std::move(layers), true,
                  [settings = parameters.filter](const screenspace::FilterFeatures& features) {
                      return screenspace::make_own_filter(features, settings);
                  }) {}

LayerFilter::LayerFilter(const Scene& scene, const RenderOptions& options, const FeatureSettings& features,
                         std::shared_ptr<const screenspace::OidnLibrary> library, std::vector<Choice> layers)
    : LayerFilter(scene, options, features, std::move(layers), false,
                  [library = std::move(library)](const screenspace::FilterFeatures& found) {
                      return screenspace::make_oidn_filter(found, library);
                  }) {}

void LayerFilter::find_features(CancelToken cancelled) {
    if (filter_) return;
    options_.cancelled = cancelled;
    const Stopwatch stopwatch(feature_seconds_);
    features_ = std::make_unique<screenspace::FilterFeatures>(
        find_filter_features(scene_, options_, feature_settings_));
    filter_ = make_(*features_);
}

void LayerFilter::apply(Film& film, CancelToken cancelled) {
    for (const Choice& choice : layers_)
        if (!film.has_squares(choice.layer))
            throw std::invalid_argument("a filtered layer needs its squares");
    if (layers_.empty() || (has_variance_ && !film.has_passes(2))) return;
    variances_.clear();
    find_features(cancelled);
    const Stopwatch stopwatch(filter_seconds_);
    for (const Choice& choice : layers_) {
        const std::uint32_t passes = film.pass_count(film.layers()[choice.layer].part);
        if (passes == 0) continue;
        film.set_mean(choice.layer,
                      {});  // of the passes: an earlier call, for a preview, may have replaced it
        const std::vector<Rgb> mean = film.mean(choice.layer);
        const std::vector<Rgb> variance = passes > 1 ? film.layer_variance_of_mean(choice.layer)
                                                     : std::vector<Rgb>(mean.size(), Rgb(infinity));
        auto filtered = filter_->filtered({mean, variance, choice.kind}, cancelled);
        film.set_mean(choice.layer, filtered.mean, filtered.variance);
        variances_.push_back(std::move(filtered.variance));
    }
}

void LayerFilter::add_statistics(Statistics& statistics) const {
    if (layers_.empty()) return;
    statistics.seconds["filter_features"] = feature_seconds_;
    statistics.seconds["filter"] = filter_seconds_;
}

}  // namespace mote::integrators
