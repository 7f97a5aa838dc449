#include "integrators/layer_filter/layer_filter.h"

#include <chrono>
#include <stdexcept>

namespace mote::integrators {

using namespace core;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

LayerFilterParameters read_layer_filter(const Properties& p) {
    LayerFilterParameters result;
    result.filter.levels = int(p.get_int_in("filter_levels", result.filter.levels, 1, 12));
    result.filter.confidence =
        float(p.get_float_in("filter_confidence", double(result.filter.confidence), 0.0, 1e6));
    result.features.samples = int(p.get_int_in("filter_samples", result.features.samples, 1, 256));
    return result;
}

std::vector<Parameter> layer_filter_parameters() {
    return {{"filter_levels", "integer", "4",
             "levels of details that the filter takes apart: pixels up to 2^(levels + 1) away are averaged"},
            {"filter_confidence", "float", "2",
             "how many times the energy of noise a detail must have to be kept; 0 filters nothing"},
            {"filter_samples", "integer", "16",
             "eye rays a pixel that look for edges, apart from those of the passes"}};
}

LayerFilter::LayerFilter(const Scene& scene, const RenderOptions& options,
                         const LayerFilterParameters& parameters)
    : scene_(scene), options_(options), parameters_(parameters) {}

void LayerFilter::find_features(CancelToken cancelled) {
    if (features_) return;
    options_.cancelled = cancelled;
    const auto start = Clock::now();
    features_ = std::make_unique<screenspace::FilterFeatures>(
        find_filter_features(scene_, options_, parameters_.features));
    feature_seconds_ += seconds_since(start);
}

void LayerFilter::apply(Film& film, std::span<const Choice> layers, CancelToken cancelled) {
    variances_.clear();
    find_features(cancelled);
    const auto start = Clock::now();
    for (const Choice& choice : layers) {
        if (!film.has_squares(choice.layer))
            throw std::invalid_argument("a filtered layer needs its squares");
        film.set_mean(choice.layer,
                      {});  // of the passes: an earlier call, for a preview, may have replaced it
        const std::vector<Rgb> mean = film.mean(choice.layer);
        const std::vector<Rgb> variance = film.layer_variance_of_mean(choice.layer);
        auto filtered = screenspace::filter_layer(*features_, {mean, variance, choice.kind},
                                                  parameters_.filter, cancelled);
        film.set_mean(choice.layer, filtered.mean, filtered.variance);
        variances_.push_back(std::move(filtered.variance));
    }
    filter_seconds_ += seconds_since(start);
}

}  // namespace mote::integrators
