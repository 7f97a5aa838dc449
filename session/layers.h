// The layers of a picture by name: which channels belong together.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/film/image_channels.h"

namespace mote::session {

/// The name of the layer whose channels are plain R, G and B.
inline const std::string beauty_layer = "beauty";
/// The name of the layer whose channel is plain A: 1 where a pixel is finished.
inline const std::string alpha_layer = "alpha";

struct LayerChannels {
    std::string name;                   ///< "beauty", "direct", "Depth", "Variance.direct"
    std::vector<std::string> channels;  ///< what follows the name: "R", "G", "B", or "Z"
    std::vector<std::size_t> planes;    ///< of the picture, in this order
};

/// In the order in which the picture has them; colours as R, G, B and vectors as X, Y, Z.
std::vector<LayerChannels> layers_of(const core::ImageChannels& image);
/// Throws InputError with the nearest name there is.
LayerChannels find_layer(const core::ImageChannels& image, const std::string& name);
/// Adds a layer of 1 or 3 channels side by side, or replaces it: R, G, B; X, Y, Z where it holds vectors (P,
/// N, Ns, PreviousP, MotionVector and what ends in them behind a dot); Z of Depth, A of alpha, Y of any other
/// with one channel. A picture without channels takes the size. Throws InputError for other sizes or numbers
/// of channels.
void set_layer(core::ImageChannels& image, const std::string& name, int width, int height, int channels,
               std::span<const float> values);
/// Values of a layer, row by row from the top, its channels side by side. Throws std::invalid_argument unless
/// `values` has width * height * channels entries.
void copy_layer(const core::ImageChannels& image, const LayerChannels& layer, std::span<float> values);

}  // namespace mote::session
