// Metadata by which a picture can be a reference: its scene, camera, files and noise.
#pragma once

#include <string>
#include <vector>

#include "core/film/image_channels.h"
#include "core/scene/scene.h"

namespace mote::session {

/// Names of the files that the scene was read from, a line each: where none has changed, the picture need not
/// be made anew.
inline const char* const scene_files_key = "sceneFiles";
std::string as_lines(const std::vector<std::string>& names);
std::vector<std::string> lines_of(const std::string& text);

/// worldToCamera of OpenEXR, 16 numbers: a left-handed camera space, matrices acting on row vectors.
std::string world_to_camera(const core::Camera& camera);

/// Two such texts, apart from rounding to float.
bool same_camera(const std::string& a, const std::string& b);

/// Factor by which the variance of a picture is smaller than its layer `Variance`, over all pixels: passes
/// are Sobol points, and better than independent ones (Film::gain_and_noise).
inline const char* const variance_gain_key = "varianceGain";
/// Variance of the beauty's mean, pixel by pixel, with that gain; empty where it is not known.
std::vector<core::Rgb> variance_of_beauty(const core::ImageChannels& image);

/// Hash of the scene's files and the definitions that change them: equal whatever integrator renders it.
std::string scene_content(const core::Scene& scene, std::vector<std::string> defines);

}  // namespace mote::session
