// A film as a layered picture, with the channel names that other programs know.
#pragma once

#include "core/image/film.h"
#include "core/image/image_file.h"

namespace mote::core {

/// R, G, B (the beauty); layer.R ... of every layer of it; auxiliary layers under their own names (Albedo.R,
/// N.X, P.X, Depth.Z, as pbrt names them); and Variance.R ..., the variance of the beauty's mean, from two
/// passes on.
ImageChannels film_image(const Film& film);

}  // namespace mote::core
