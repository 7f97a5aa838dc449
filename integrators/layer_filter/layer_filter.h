// Layers of a film filtered in image space (screenspace/layer_filter/view_filter.h): for Estimator::finish(),
// or for a preview, as often as one likes. The features of the view are found on first use.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/parameters/add_type.h"
#include "integrators/layer_filter/filter_plan.h"
#include "integrators/layer_filter/layer_of_passes.h"
#include "integrators/layer_filter/scene_features.h"
#include "screenspace/layer_filter/view_filter.h"

namespace mote::integrators {

struct LayerFilterParameters {
    screenspace::LayerFilterSettings filter;
    FeatureSettings features;
};

/// filter_levels, filter_confidence and filter_samples: `within(&Settings::filter, layer_filter_rows())`.
const core::ParameterList<LayerFilterParameters>& layer_filter_rows();

class LayerFilter {
  public:
    using Choice = ChosenLayer;

    /// Our own filter. The scene must outlive this; size, seed and sampler are those of the render. `layers`
    /// may be empty: then nothing is filtered.
    LayerFilter(const core::Scene& scene, const core::RenderOptions& options,
                const LayerFilterParameters& parameters, std::vector<Choice> layers);
    /// OpenImageDenoise.
    LayerFilter(const core::Scene& scene, const core::RenderOptions& options, const FeatureSettings& features,
                std::shared_ptr<const screenspace::OidnLibrary> library, std::vector<Choice> layers);

    /// Sets the means of the layers to the filtered ones: of each half of the passes by itself where the film
    /// keeps them and has two passes a half, so that its error is known. Of a layer of one pass the variance
    /// is not known, and of two or three hardly: OpenImageDenoise smooths it as far as it likes, our own
    /// filter leaves all layers of one pass as they are. Throws std::invalid_argument where a layer has no
    /// squares, and Cancelled.
    ///
    /// OpenImageDenoise does what the film's work is worth (filter_plan.h): the sum of all layers of a kind
    /// at once at first, each of which keeps its fraction of a pixel, and features with their noise; later
    /// layer by layer, and at twice the resolution where the film has that
    /// (screenspace/layer_filter/fine_pixels.h).
    void apply(core::Film& film, core::CancelToken cancelled = {});

    /// apply() for a preview: OpenImageDenoise takes sums always, and quickly. Returns true where it is the
    /// same: for our own filter.
    bool apply_for_preview(core::Film& film, core::CancelToken cancelled = {});
    /// Wall time of apply() after another pass, by that of the last call of either [s].
    double seconds_to_apply(const core::Film& film) const;
    /// From now on there is no time for better features than those of the last call of either, but where
    /// this film is worth better ones already.
    void keep_features(const core::Film& film);

    const std::vector<Choice>& layers() const { return layers_; }
    /// True where apply() filters the halves of this film.
    bool has_halves(const core::Film& film) const;
    /// True if layers are filtered, and the filter needs their variance and says what it leaves: our own.
    bool has_variance() const { return !library_ && !layers_.empty(); }
    /// Remaining variance of each layer of the last apply() of whole passes, mean over channels, in its
    /// order; empty: unknown.
    const std::vector<std::vector<float>>& variances() const { return variances_; }
    /// Wall time of all features so far [s].
    double feature_seconds() const { return feature_seconds_ + last_feature_seconds_; }
    /// Wall time of features and of all calls, where there are layers.
    void add_statistics(core::Statistics& statistics) const;

  private:
    using MakeFilter = std::function<std::unique_ptr<screenspace::ViewFilter>(
        const screenspace::FilterFeatures&, screenspace::FilterQuality)>;
    LayerFilter(const core::Scene& scene, const core::RenderOptions& options, const FeatureSettings& features,
                std::vector<Choice> layers, std::shared_ptr<const screenspace::OidnLibrary> library,
                MakeFilter make);
    /// With rough features where it keeps them.
    FilterPlan plan(const core::Film& film, std::uint32_t more = 0) const;
    /// Its variance is used from two passes on, or four: around a bright pixel that one of two passes has,
    /// the layer by OpenImageDenoise differs from the mean by more than the noise of the dark pixels there,
    /// and would be mixed with it in rings.
    LayerOfPasses of_passes(core::Film& film, std::size_t layer) const;
    /// Features of the quality that the film's work is worth.
    void find_features(const FilterPlan& now, core::CancelToken cancelled);
    bool has_full_features() const { return filter_ && found_quality_ == screenspace::FilterQuality::full; }
    bool needs_full_features(const FilterPlan& of) const { return of.full_features && !has_full_features(); }
    bool needs_quarters(const FilterPlan& of) const { return !of.fine.empty() && !fine_; }
    double seconds_to_find_features(const FilterPlan& next) const;
    void find_noise_free(const core::Film& film);
    void find_quarters(const FilterPlan& now, core::CancelToken cancelled);
    void apply_to_fine(core::Film& film, std::size_t layer, core::CancelToken cancelled);
    /// Time of a run at full quality over that of one for a preview.
    double time_of_run(const FilterPlan& of) const;
    /// Time of apply() in that of one layer.
    double runs(const core::Film& film, const FilterPlan& of) const;
    void apply_to_halves(core::Film& film, const Choice& choice, core::CancelToken cancelled);
    void apply_to_mean(core::Film& film, const Choice& choice, core::CancelToken cancelled);
    void apply_to_sums(core::Film& film, screenspace::FilterQuality quality, double time_of_run,
                       core::CancelToken cancelled);
    void apply_to_sum(core::Film& film, const LayersOfKind& kind, screenspace::FilterQuality quality,
                      core::CancelToken cancelled);

    const core::Scene& scene_;
    core::RenderOptions options_;
    FeatureSettings feature_settings_;
    std::vector<Choice> layers_;
    std::shared_ptr<const screenspace::OidnLibrary> library_;  ///< null: our own filter
    MakeFilter make_;
    std::unique_ptr<screenspace::FilterFeatures> features_;
    std::unique_ptr<screenspace::ViewFilter> filter_;  ///< from the features
    std::unique_ptr<screenspace::FinePixels> fine_;
    screenspace::FilterQuality found_quality_ = screenspace::FilterQuality::full;  ///< of the features
    bool keeps_features_ = false;                                                  ///< without better ones
    std::vector<std::vector<float>> variances_;
    double feature_seconds_ = 0.0, filter_seconds_ = 0.0;
    double last_feature_seconds_ = 0.0;    ///< of the features that there are, without those of quarters
    double seconds_per_run_ = 0.0;         ///< of the filter for a preview, by the last call
    std::vector<std::size_t> noise_free_;  ///< layers without variance in the last film
};

}  // namespace mote::integrators
