// PNG previews, which say with which exposure they were made.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/film/image_channels.h"

namespace mote::session {

/// Key of the text in which a preview says its exposure.
inline const std::string exposure_key = "Exposure";

/// Writes R, G and B of the picture, by filmic_tone(), so that highlights keep their shape. Without an
/// exposure [stops] it adapts to the picture. Returns what the file says of it under "Exposure": "+1.25
/// stops, adapted to the key value 0.18", or "+1.00 stops, fixed".
/// A picture whose metadata calls it `denoised` says so under "Denoised".
/// `finished` (one a pixel, or empty: all are): the others are shown as a chequered ground.
std::string write_preview(const std::string& path, const core::ImageChannels& image,
                          std::optional<float> exposure = {}, std::span<const std::uint8_t> finished = {});
/// That text, for a picture that is written otherwise.
std::string exposure_text(float stops, bool fixed);

}  // namespace mote::session
