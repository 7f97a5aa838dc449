// The first picture of a long render: all of it at half the resolution, which takes a quarter of a pass.
#pragma once

#include <optional>

#include "core/film/image_channels.h"
#include "session/render.h"

namespace mote::session {

/// True where such a picture is worth its time: with a limit of 20 s or more, a film of 2^18 pixels or more,
/// and a scene that was loaded within a second, since it is loaded again.
bool coarse_preview_pays(const LoadedScene& scene, const RenderSettings& settings);

/// R, G and B of one pass at half the resolution, finished, and enlarged to the size of the film. Nothing
/// where `observer` cancels it, the only function of it that is called, where it would take a tenth of the
/// limit in time, and where it fails.
std::optional<core::ImageChannels> coarse_preview(const LoadedScene& scene, const RenderSettings& settings,
                                                  RenderObserver& observer);

/// R, G and B at another size, bilinear between the pixels' centres.
core::ImageChannels enlarged(const core::ImageChannels& image, int width, int height);

}  // namespace mote::session
