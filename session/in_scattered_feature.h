// Light that media scatter once towards the eye, without noise: what light of media is regressed on.
#pragma once

#include <string>

#include "core/film/image_channels.h"
#include "core/objects/registry.h"
#include "core/scene/scene.h"

namespace mote::session {

inline const std::string in_scattered_layer = "InScattered";

/// Adds the layer: of the lights that have a position, marched along one ray a pixel as
/// `mote_single_scattering` does. Nothing where there are none, where nothing scatters, or where the picture
/// has it as a layer of its own.
void add_in_scattered(core::ImageChannels& image, const core::Scene& scene, const core::Registry& registry);

/// That layer of a picture, or the one of a method that marches; empty where it has neither.
std::vector<core::Rgb> in_scattered(const core::ImageChannels& image);

}  // namespace mote::session
