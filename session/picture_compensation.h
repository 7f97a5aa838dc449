// Screen-space compensation of a finished picture: its bound from the metadata, its layers, and the result in
// it.
#pragma once

#include <vector>

#include "core/film/image_channels.h"
#include "screenspace/ssbc/ssbc.h"
#include "screenspace/ssbc/ssbc_picture.h"

namespace mote::session {

/// The layer that is added.
inline const char* const compensation_layer = "compensation_surface";

/// The bound that the picture was rendered with [1/m^2], from its metadata; 0 where that does not say.
float bound_of(const core::ImageChannels& image);
bool is_compensated(const core::ImageChannels& image);
/// Takes the compensation that the picture holds out of its beauty.
void take_out_compensation(core::ImageChannels& image);
/// Adds the compensation to the beauty, and as a layer.
void add_compensation(core::ImageChannels& image, const std::vector<core::Rgb>& compensation);

/// All of it, for pictures that hold their surfaces (screenspace/ssbc/ssbc_picture.h): `settings.bound` 0 is
/// the picture's own; `replace` takes out what is there. Throws InputError for what the picture lacks, and
/// where it is compensated already; std::invalid_argument for settings out of range.
screenspace::SsbcResult compensate_picture(core::ImageChannels& image, screenspace::SsbcSettings settings,
                                           const screenspace::SsbcChannels& channels = {},
                                           bool replace = false);

}  // namespace mote::session
