// What the camera sees besides light, as channels of a picture: for denoisers, and for `mote ssbc`.
#pragma once

#include "core/image/image_file.h"
#include "core/scene/scene.h"

namespace mote::apps {

/// Adds, at pixel centres: P, N, Ns (geometric and shading normal, turned to the viewer) in the world,
/// Depth.Z (along the ray; infinity where nothing is hit), Albedo of the whole BSDF, and DiffuseAlbedo of
/// what it reflects to all sides alike. The picture must have the size of the scene's film.
void add_auxiliary_channels(core::ImageChannels& image, const core::Scene& scene);

}  // namespace mote::apps
