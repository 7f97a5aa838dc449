// The mean of what a point looked like in this frame and those before:
//   y_n = (1 - a) y_(n-1) + a x_n,    a = max(1 / n, 1 / longest).                                      (1)
// n is counted in every pixel and begins anew where the point was not seen. Up to the longest history the
// mean is the plain one of n frames, with a variance of 1 / n; then it forgets exponentially, with 1 / (2
// longest - 1).
//
// Light may change where nothing moves. History is kept as far as its mean over 7 x 7 pixels agrees with
// that of the frame, within so many standard errors: beyond, n is cut down by the square of the excess.
#pragma once

#include "screenspace/denoising/reprojection.h"

namespace mote::screenspace {

struct AccumulationSettings {
    float longest = 32.0f;  ///< history [frames]; infinity: the plain mean as long as nothing moves
    float change =
        4.0f;  ///< standard errors between frame and history that are taken for chance; infinity: all
};

class TemporalAccumulation {
  public:
    explicit TemporalAccumulation(const AccumulationSettings& settings = {});

    /// The next frame: `history` says where its points were (empty: this is the first frame). A colour that
    /// is not finite adds nothing. Returns Eq. (1) for every pixel; not finite where nothing finite was ever
    /// seen. Throws std::invalid_argument when sizes differ.
    const std::vector<core::Rgb>& add(int width, int height, std::span<const PixelHistory> history,
                                      std::span<const core::Rgb> colour);
    std::span<const float> length() const { return length_; }  ///< n of Eq. (1), interpolated [frames]

  private:
    void cut_where_light_changed(int width, int height, std::span<const core::Rgb> colour,
                                 std::span<const core::Rgb> past, std::span<float> length) const;

    AccumulationSettings settings_;
    std::vector<core::Rgb> mean_;
    std::vector<float> length_;
};

}  // namespace mote::screenspace
