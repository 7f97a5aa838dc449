// Channels besides light: layers of the render for denoisers, channels at pixel centres for
// `mote ssbc`.
#pragma once

#include <span>
#include <string>

#include "core/film/image_channels.h"
#include "core/render/first_hit_features.h"

namespace mote::session {

/// core::first_hit_features(), and DiffuseAlbedo: what the BSDF reflects to all sides alike.
std::vector<core::HitFeature> auxiliary_features(const core::Scene& scene);

/// Those of them with these names (which a scene file names by an integrator `aov`), and Coverage; none
/// for none.
std::vector<core::HitFeature> features_by_name(const core::Scene& scene,
                                               std::span<const std::string> requested);

/// Features of a denoiser: Albedo and Ns, besides `requested`. `regression`: it regresses on P, Depth and
/// Transmittance as well.
std::vector<core::HitFeature> features_for_denoising(const core::Scene& scene,
                                                     std::vector<std::string> requested, bool regression);

/// Features of the first hit that are written: all (`auxiliary`), or those of a denoiser
/// ("oidn", "bmfr"; "": none), with those that `requested` names.
std::vector<core::HitFeature> wanted_features(const core::Scene& scene,
                                              const std::vector<std::string>& requested, bool auxiliary,
                                              const std::string& denoise);

/// Adds Center.P, Center.N (geometric, turned to the viewer) and Center.DiffuseAlbedo: what the rays through
/// the middle of the pixels and of the lens hit, zero where that is nothing. The picture must have the size
/// of the scene's film. Methods in the space of the picture need sharp edges, which the features are filtered
/// over.
void add_center_channels(core::ImageChannels& image, const core::Scene& scene);

/// Adds ObjectId.Y and MaterialId.Y: of the first surface that the ray through the middle of the pixel and of
/// the lens hits, counted from 1 in the order of the scene, 0 where that is nothing. An instance is another
/// object, the BSDF of several shapes is one material. A mask is met by chance, in all frames alike.
void add_ids(core::ImageChannels& image, const core::Scene& scene);

}  // namespace mote::session
