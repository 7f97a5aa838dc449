// The camera of a finished picture, from its metadata and the positions that it sees.
#pragma once

#include <optional>

#include "core/film/image_channels.h"
#include "screenspace/denoising/reprojection.h"

namespace mote::session {

/// From `worldToCamera` of the metadata and from where in the picture the positions are: in the camera's
/// space (x, y, z) lies at pixel a x / z + b, or a x + b for parallel rays, whose a and b are fitted. Nothing
/// where there is no such metadata, or no fit is within a pixel on average, as with other projections.
/// `position`: not finite where nothing was hit.
std::optional<screenspace::FrameCamera> frame_camera(const core::ImageChannels& image,
                                                     std::span<const core::Vec3> position);

}  // namespace mote::session
