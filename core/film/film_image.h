// A film as a layered picture, with the channel names that other programs use.
#pragma once

#include "core/film/film.h"
#include "core/film/image_channels.h"

namespace mote::core {

/// R, G, B (the beauty); layer.R ... of every layer of it; auxiliary layers under their own names (Albedo.R,
/// N.X, P.X, Depth.Z, as pbrt names them; Depth is infinite where nothing was hit); and from two passes of
/// every part on the variance of means: Variance.R ... of the beauty, Variance.N.X ... of auxiliary layers
/// whose squares the film keeps.
ImageChannels film_image(const Film& film);

/// Pixels whose variance was too large for a float, so that the picture says infinity.
std::uint64_t infinite_variances(const ImageChannels& image);

}  // namespace mote::core
