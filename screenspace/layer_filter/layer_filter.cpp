#include "screenspace/layer_filter/layer_filter.h"

#include "screenspace/layer_filter/mixed_pixels.h"
#include "screenspace/layer_filter/shrinkage.h"
#include "screenspace/layer_filter/view_filter.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// The variance of what the probes have become.
std::vector<float> variance_of(const FilterChannels& probes, const FilterChannels& change) {
    std::vector<float> result(probes.planes[0].size());
    constexpr float per_plane = 1.0f / float(FilterChannels::probes);
    for (std::size_t c = FilterChannels::colours; c < FilterChannels::count; ++c)
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] += per_plane * sqr(probes.planes[c][i] + change.planes[c][i]);
    return result;
}

class OwnFilter final : public ViewFilter {
  public:
    OwnFilter(const FilterFeatures& features, const LayerFilterSettings& settings)
        : features_(features), settings_(settings) {}
    FilteredLayer filtered(const LayerToFilter& layer, CancelToken cancelled) override {
        return filter_layer(features_, layer, settings_, cancelled);
    }

  private:
    const FilterFeatures& features_;
    LayerFilterSettings settings_;
};

}  // namespace

FilteredLayer filter_layer(const FilterFeatures& features, const LayerToFilter& layer,
                           const LayerFilterSettings& settings, CancelToken cancelled) {
    const FilterPlanes planes(features, layer);
    const FilterChannels channels = demodulated(features, planes, layer);
    const auto [change, of_gains] = shrink_details(planes, channels, settings, cancelled);
    const std::vector<float> left = smoothed(planes, variance_of(channels, change), cancelled);
    FilteredLayer result{{layer.mean.begin(), layer.mean.end()}, left};
    for (std::size_t i = 0; i < features.pixels(); ++i) {
        if (!(planes.weight[i] > 0.0f)) {
            result.variance[i] = is_finite(layer.variance[i]) ? average(layer.variance[i]) : 0.0f;
            continue;
        }
        const Rgb m = modulation(features, layer.kind, i);
        result.mean[i] += m * Rgb(change.planes[0][i], change.planes[1][i], change.planes[2][i]);
        result.variance[i] *= average(m * m);
    }
    put_mixed_together(features, layer, planes, result, cancelled);
    for (std::size_t i = 0; i < features.pixels(); ++i) {
        if (!(planes.weight[i] > 0.0f) || features.kind[i] == PixelKind::mixed) continue;
        const Rgb m = modulation(features, layer.kind, i);
        result.variance[i] += average(m * m) * of_gains[i];
    }
    // Regression extrapolates, also below zero.
    for (std::size_t i = 0; i < features.pixels(); ++i)
        if (planes.weight[i] > 0.0f || features.kind[i] == PixelKind::mixed)
            result.mean[i] = glm::max(result.mean[i], glm::min(layer.mean[i], Rgb(0.0f)));
    return result;
}

std::unique_ptr<ViewFilter> make_own_filter(const FilterFeatures& features,
                                            const LayerFilterSettings& settings) {
    return std::make_unique<OwnFilter>(features, settings);
}

}  // namespace mote::screenspace
