// Layers of a film filtered in image space (screenspace/layer_filter/view_filter.h): for Estimator::finish(),
// or for a preview, as often as one likes. The features of the view are found on first use.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/film/film.h"
#include "core/parameters/add_type.h"
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
    struct Choice {
        std::size_t layer;  ///< of the film, which must keep its squares
        screenspace::LayerKind kind;
    };

    /// Our own filter. The scene must outlive this; size, seed and sampler are those of the render.
    LayerFilter(const core::Scene& scene, const core::RenderOptions& options,
                const LayerFilterParameters& parameters);
    /// OpenImageDenoise.
    LayerFilter(const core::Scene& scene, const core::RenderOptions& options, const FeatureSettings& features,
                std::shared_ptr<const screenspace::OidnLibrary> library);

    /// Sets the means of these layers to the filtered ones. A film of fewer than two passes has no variance
    /// and stays as it is. Throws std::invalid_argument where a layer has no squares, and Cancelled.
    void apply(core::Film& film, std::span<const Choice> layers, core::CancelToken cancelled = {});

    /// True if the filter says what variance it leaves: our own.
    bool knows_variance() const { return knows_variance_; }
    /// Remaining variance of each layer of the last apply(), mean over channels, in its order; empty:
    /// unknown.
    const std::vector<std::vector<float>>& variances() const { return variances_; }
    double feature_seconds() const { return feature_seconds_; }  ///< wall time
    double filter_seconds() const { return filter_seconds_; }    ///< of all calls

  private:
    using MakeFilter =
        std::function<std::unique_ptr<screenspace::ViewFilter>(const screenspace::FilterFeatures&)>;
    LayerFilter(const core::Scene& scene, const core::RenderOptions& options, const FeatureSettings& features,
                bool knows_variance, MakeFilter make);
    void find_features(core::CancelToken cancelled);

    const core::Scene& scene_;
    core::RenderOptions options_;
    FeatureSettings feature_settings_;
    bool knows_variance_;
    MakeFilter make_;
    std::unique_ptr<screenspace::FilterFeatures> features_;
    std::unique_ptr<screenspace::ViewFilter> filter_;  ///< from the features
    std::vector<std::vector<float>> variances_;
    double feature_seconds_ = 0.0, filter_seconds_ = 0.0;
};

}  // namespace mote::integrators
