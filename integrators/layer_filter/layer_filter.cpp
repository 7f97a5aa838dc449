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

LayerFilter::LayerFilter(const Scene& scene, const RenderOptions& options,
                         const LayerFilterParameters& parameters, std::vector<Choice> layers)
    : scene_(scene), options_(options), parameters_(parameters), layers_(std::move(layers)) {}

void LayerFilter::find_features(CancelToken cancelled) {
    if (features_) return;
    options_.cancelled = cancelled;
    const Stopwatch stopwatch(feature_seconds_);
    features_ = std::make_unique<screenspace::FilterFeatures>(
        find_filter_features(scene_, options_, parameters_.features));
}

void LayerFilter::apply(Film& film, CancelToken cancelled) {
    for (const Choice& choice : layers_)
        if (!film.has_squares(choice.layer))
            throw std::invalid_argument("a filtered layer needs its squares");
    if (layers_.empty() || !film.has_passes(2)) return;
    variances_.clear();
    find_features(cancelled);
    const Stopwatch stopwatch(filter_seconds_);
    for (const Choice& choice : layers_) {
        film.set_mean(choice.layer,
                      {});  // of the passes: an earlier call, for a preview, may have replaced it
        const std::vector<Rgb> mean = film.mean(choice.layer);
        const std::vector<Rgb> variance = film.layer_variance_of_mean(choice.layer);
        auto filtered = screenspace::filter_layer(*features_, {mean, variance, choice.kind},
                                                  parameters_.filter, cancelled);
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
