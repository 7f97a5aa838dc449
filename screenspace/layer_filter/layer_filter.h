// A noisy layer of a picture, smoothed in image space: over pixels that see one surface, or one depth of a
// medium.
//
// A layer is divided by what is known without noise (transmittance times albedo, or the scattering along the
// ray), taken apart into details of growing size by an edge-avoiding a-trous transform (Dammertz et al. 2010)
// with local linear regression, and put together again:
//   f = y + m sum_l (g_l - 1) d_l,    d_l = c_l - c_{l+1},  c_0 = y / m, (1) g_l = max(0, 1 - k E[noise of
//   d_l]^2 / E[d_l]^2).                                                        (2)
// Each detail is kept to the fraction of its local energy that noise does not explain (Wiener), where the
// energy of noise is that of random numbers of the layer's own variance that went through the same transform.
// Without noise g = 1 and the layer stays what it is, to the bit; with many passes the picture converges to
// the mean.
#pragma once

#include <vector>

#include "core/objects/cancellation.h"
#include "screenspace/layer_filter/filter_features.h"

namespace mote::screenspace {

struct LayerFilterSettings {
    int levels = 4;           ///< of details: the largest reach 2^(levels + 1) pixels
    float confidence = 2.0f;  ///< k: how many times the energy of noise a detail must have to be seen at all
};

/// Where the light of a layer comes from as seen from the eye.
enum class LayerKind : std::uint8_t { surface, volume };

/// A preview may have a somewhat larger error in less time.
enum class FilterQuality : std::uint8_t { full, preview };

struct LayerToFilter {
    std::span<const core::Rgb> mean;      ///< of the passes
    std::span<const core::Rgb> variance;  ///< of that mean
    LayerKind kind = LayerKind::surface;
    FilterQuality quality = FilterQuality::full;
};

struct FilteredLayer {
    std::vector<core::Rgb> mean;
    /// Remaining variance, mean over channels: smoothed, of the filter with its gains as they are,
    /// and as if the noise of the channels were in proportion to what the layer was divided by.
    std::vector<float> variance;
};

/// Nowhere negative where the layer is not. Pixels that are not finite, have no surface or medium, or lie on
/// a mirror stay as they are. The same for any number of threads. Throws std::invalid_argument when sizes
/// differ, and Cancelled.
FilteredLayer filter_layer(const FilterFeatures& features, const LayerToFilter& layer,
                           const LayerFilterSettings& settings, core::CancelToken cancelled = {});

}  // namespace mote::screenspace
