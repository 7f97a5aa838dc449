// A picture as the page receives it: every layer of three channels as float16, so that the page adds,
// subtracts and exposes layers without another message.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/film/image_channels.h"
#include "viewer/message.h"

namespace mote::viewer {

/// A layer that the page can show.
struct FrameLayer {
    std::string name;
    bool of_sum = false;  ///< light: one of the layers whose sum is the beauty
};
/// "beauty" first, then those whose sum it is, then all others with three channels, and the standard
/// deviation of the beauty's mean where the picture has its variance.
std::vector<FrameLayer> frame_layers(const core::ImageChannels& image);

/// Adds size, layers and scale to `header`. A pixel is its float16 times `scale`, a power of two near the
/// mean of the beauty: light in any unit fits. Values beyond the largest float16 become that.
SharedMessage encode_frame(const core::ImageChannels& image, nlohmann::json header);

/// The nearest float16, by its bits; too large ones become 65504, NaN stays NaN.
std::uint16_t to_half(float value);

}  // namespace mote::viewer
