// A filter of the layers of one view, made from the features of that view.
#pragma once

#include <memory>

#include "screenspace/denoising/oidn_library.h"
#include "screenspace/layer_filter/layer_filter.h"

namespace mote::screenspace {

class ViewFilter {
  public:
    virtual ~ViewFilter() = default;
    /// For one thread at a time. Nowhere negative where the layer is not; pixels that are not finite stay as
    /// they are. The variance is empty where it is not known. Throws Cancelled, and std::invalid_argument
    /// when sizes differ.
    virtual FilteredLayer filtered(const LayerToFilter& layer, core::CancelToken cancelled) = 0;
    /// Frees what filtered() keeps for the next layer.
    virtual void release() {}
    /// Time of a layer at full quality over that for a preview, about, where features have no noise.
    virtual double full_per_preview() const { return 1.0; }
};

/// filter_layer() with these settings. The features must outlive it.
std::unique_ptr<ViewFilter> make_own_filter(const FilterFeatures& features,
                                            const LayerFilterSettings& settings);

/// A denoised layer, mixed with its noisy mean as far as that shows more than noise (variance_blend.h).
/// Nowhere negative where the mean is not; pixels of either that are not finite are those of the mean.
std::vector<core::Rgb> mixed_with_mean(int width, int height, std::span<const core::Rgb> denoised,
                                       const LayerToFilter& layer);

/// OpenImageDenoise, combined with the noisy mean as far as that shows more than noise (variance_blend.h):
/// with many passes the picture converges to the mean. At full `quality` the features are denoised first, so
/// that lenses and edges leave no noise in them; for a preview the network takes them for noisy. Light of
/// media is denoised without normals. A layer without variance stays as it is. Throws InputError, here and
/// from filtered(), where the library fails.
std::unique_ptr<ViewFilter> make_oidn_filter(const FilterFeatures& features,
                                             std::shared_ptr<const OidnLibrary> library,
                                             FilterQuality quality = FilterQuality::full);

}  // namespace mote::screenspace
