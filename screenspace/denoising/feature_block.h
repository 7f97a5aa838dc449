// One block of a picture as the matrix of its regression.
#pragma once

#include "screenspace/denoising/block_regression.h"
#include "screenspace/denoising/least_squares.h"

namespace mote::screenspace {

struct PixelRectangle {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< without x1 and y1
    int width() const { return x1 - x0; }
    int pixels() const { return (x1 - x0) * (y1 - y0); }
};

/// Centre and scale that map a feature to [-1, 1].
struct FeatureScale {
    float centre = 0.0f, scale = 0.0f;  ///< (f - centre) * scale; 0 where it does not vary
};
/// From the values of the pixels that take part; +-rounding is no variation.
FeatureScale feature_scale(float lowest, float highest);

/// Columns of features: 1, then each plane, and behind it its square.
int feature_columns(std::span<const FeaturePlane> features);

class FeatureBlock {
  public:
    /// `has_features`: of every pixel of the picture, whether all of its features are finite.
    FeatureBlock(int picture_width, std::span<const FeaturePlane> features, std::span<const core::Rgb> colour,
                 std::span<const std::uint8_t> has_features);

    /// Fits a block of the picture to its pixels that have features and a colour. False when there are none.
    /// Takes noise and weights from the settings.
    bool fit(const PixelRectangle& block, const RegressionSettings& settings, std::uint64_t seed);
    /// The fit at the pixels of a row, for columns x0 to x0 + result.size() of that block.
    void evaluate(int x0, int y, std::span<core::Rgb> result) const;

  private:
    void fill_matrix(const PixelRectangle& block, float noise, std::uint64_t seed);
    void fit_weighted(const PixelRectangle& block, float noise, std::uint64_t seed);
    /// False where Eq. (2) has nothing to do, known from the coefficients alone.
    bool may_be_uneven(const PixelRectangle& block) const;
    /// Black where a pixel took no part.
    std::vector<core::Rgb> values_of_fit(const PixelRectangle& block) const;
    void find_scales(const PixelRectangle& block);
    void fill_features(const PixelRectangle& block);
    void fill_colours(const PixelRectangle& block);
    void add_noise(float noise, std::uint64_t seed);

    std::size_t picture_width_;
    std::span<const FeaturePlane> features_;
    std::span<const core::Rgb> colour_;
    std::span<const std::uint8_t> has_features_;
    TallMatrix matrix_;
    std::vector<FeatureScale> scales_;
    std::vector<float> coefficients_;
    glm::dvec3 energy_{0.0};                ///< sum of the colours that take part
    std::vector<std::uint8_t> takes_part_;  ///< of the pixels of the block
};

}  // namespace mote::screenspace
