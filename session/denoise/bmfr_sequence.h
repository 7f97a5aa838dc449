// The layer `denoised` by block-wise feature regression, for pictures of one sequence in order.
#pragma once

#include <optional>

#include "core/film/image_channels.h"
#include "screenspace/denoising/sequence_denoiser.h"

namespace mote::session {

class BmfrSequence {
  public:
    /// `single`: of one picture; it gets four overlapping grids of blocks, where a sequence gets one a frame.
    explicit BmfrSequence(bool single);

    /// Adds the layer and says how it was made. Light scattered first on surfaces is divided by Albedo and
    /// regressed on Ns and P; light scattered first in a medium on the place in the picture, Depth and
    /// Transmittance; emission stays. Features that are not there take no part; without any, the place in the
    /// picture does. Motion: the channels MotionVector.X and .Y, else P seen by the cameras of both frames;
    /// without either there is no history. Throws InputError where there is no beauty or the layer is there
    /// already.
    void add_denoised_layer(core::ImageChannels& image);

  private:
    bool single_;
    screenspace::SequenceDenoiser denoiser_;
    std::optional<screenspace::FrameCamera> camera_;  ///< of the frame before
    std::string camera_place_;                        ///< worldToCamera of it
    int width_ = 0, height_ = 0;
    std::size_t layers_ = 0;
};

}  // namespace mote::session
