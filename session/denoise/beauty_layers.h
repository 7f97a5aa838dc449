// The layers that a picture is the sum of.
#pragma once

#include <string>
#include <vector>

#include "core/film/image_channels.h"

namespace mote::session {

/// Names of the colours that make up the beauty, without features, variances and the like.
std::vector<std::string> layers_of_beauty(const core::ImageChannels& image);
/// True if they add up to it, apart from the rounding of every layer to float16. Not without any.
bool layers_add_up(const core::ImageChannels& image, const std::vector<std::string>& layers,
                   std::span<const core::Rgb> beauty);
/// The planes layer.X, .Y, .Z as one vector a pixel; empty where one is missing.
std::vector<core::Vec3> vector_layer(const core::ImageChannels& image, const std::string& layer);
/// "direct, indirect"
std::string joined(const std::vector<std::string>& names);

}  // namespace mote::session
