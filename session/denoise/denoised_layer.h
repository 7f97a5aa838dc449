// The layer `denoised` of a picture: for the eye. Everything else in the picture stays as it was measured.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "core/film/image_channels.h"
#include "screenspace/denoising/oidn_library.h"

namespace mote::session {

/// The layer, and the entry of the metadata that says how it was made.
inline const std::string denoised_layer = "denoised";

/// Adds the layer: the sum of the layers that make up the beauty, each denoised by itself, with Albedo and Ns
/// (first_hit_features.h) where the picture has them. Emission, which has no noise but at edges, stays as it
/// is. Where the layers do not add up to the beauty, as in pictures of other programs, it is denoised as a
/// whole. Throws InputError where there is no beauty, where the picture has such a layer already, and where
/// the library fails.
void add_denoised_layer(core::ImageChannels& image, const screenspace::OidnLibrary& library);

/// Adds the layer to one picture after the other.
using Denoiser = std::function<void(core::ImageChannels&)>;
/// The method "oidn" or "bmfr" (bmfr_sequence.h). `threads` 0: as many as there are cores. `sequence`: the
/// pictures are frames of one, in their order. `package`: as OidnLibrary takes it. Throws InputError for
/// another name, and where the library is not installed.
Denoiser make_denoiser(const std::string& method, int threads, bool sequence = false,
                       const std::string& package = "");

/// The denoised layer with its metadata, as a picture of its own.
core::ImageChannels denoised_picture(const core::ImageChannels& image);

/// Warning where a picture is measured that holds such a layer; "" where it does not. `layer`: that is
/// measured, "" for the beauty.
std::string denoised_doubt(const std::map<std::string, std::string>& metadata, const std::string& path,
                           const std::string& layer);

}  // namespace mote::session
