// BMFR as a whole, frame by frame (Koskela et al. 2019): accumulation of what is noisy, the regression,
// accumulation of what is not any more. A single picture is a sequence of one.
//
// The light of a frame comes in layers, each with what it is a function of: that of surfaces is divided by
// their albedo and regressed on normals and positions; of light that a medium scatters these say little.
#pragma once

#include <optional>
#include <vector>

#include "screenspace/denoising/block_regression.h"
#include "screenspace/denoising/temporal_accumulation.h"

namespace mote::screenspace {

/// One layer of a frame; the layers are denoised apart.
struct DenoiserLayer {
    std::span<const core::Rgb> colour;   ///< radiance
    std::span<const core::Rgb> albedo;   ///< divided out and multiplied back; empty: nothing is
    std::vector<FeaturePlane> features;  ///< of the regression
};

/// One frame of a sequence.
struct DenoiserFrame {
    FrameFeatures features;               ///< for reprojection
    std::vector<DenoiserLayer> layers;    ///< that add up to the picture
    std::span<const core::Rgb> variance;  ///< of the layers' sum; empty: not known
};

/// Settings for all frames.
struct DenoiserSettings {
    RegressionSettings regression;                     ///< its offset and seed are those of the frame
    RejectionSettings rejection;                       ///< which pixels of the frame before are taken
    AccumulationSettings before;                       ///< of noisy colours
    AccumulationSettings after{8.0f, core::infinity};  ///< of denoised ones, whose blocks move
    bool regress = true;                               ///< false: accumulation alone
    bool refine = true;                                ///< in smaller blocks, where they find more than noise
    bool blend = true;                                 ///< by the variance, where it is known
};

/// Denoises frames one after the other. What no feature distinguishes from its neighbourhood is blurred: a
/// shadow's edge on an even wall, unless `variance` holds the picture against it.
class SequenceDenoiser {
  public:
    /// Before the first frame.
    explicit SequenceDenoiser(const DenoiserSettings& settings = {});

    /// The next frame, which has the layers of those before it. `connected` false: nothing is taken from
    /// those, such as after a cut. Frames may differ in size, since motion leads to pixels of the frame
    /// before; throws std::invalid_argument where parts of one do, or there is no layer.
    std::vector<core::Rgb> add(const DenoiserFrame& frame, bool connected = true,
                               core::CancelToken cancelled = {});
    /// Frames that the pixels of the last one were accumulated from.
    std::span<const float> history() const;
    std::uint64_t filled() const { return filled_; }  ///< colours of the last frame that were not finite

  private:
    struct LayerHistory {
        TemporalAccumulation before, after;
    };
    struct LayerResult {
        std::vector<core::Rgb> noisy, denoised;  ///< radiance
    };
    std::vector<PixelHistory> find_history(const FrameFeatures& features) const;
    LayerResult denoise(const DenoiserFrame& frame, const DenoiserLayer& layer, LayerHistory& history,
                        std::span<const PixelHistory> pixels, core::CancelToken cancelled);
    void remember(const FrameFeatures& features);

    DenoiserSettings settings_;
    int frame_ = 0;
    std::uint64_t filled_ = 0;
    std::vector<LayerHistory> layers_;
    // The frame before.
    int width_ = 0, height_ = 0;
    std::vector<core::Vec3> position_, normal_;
    std::vector<std::uint32_t> id_;
};

}  // namespace mote::screenspace
