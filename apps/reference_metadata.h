// What a picture says about itself so that others can be judged by it: of which scene and camera it is, and
// how far it may be from the truth.
#pragma once

#include <string>
#include <vector>

#include "core/image/film.h"
#include "core/scene/scene.h"

namespace mote::apps {

/// Root of the relMSE that the film's picture is expected to have: of variance / (mean^2 + 0.01), averaged
/// over pixels and channels, so that it compares with the errors in core/image/metrics.h. Infinity for fewer
/// than two passes.
double relative_standard_error(const core::Film& film);
/// Standard error of the picture's mean over that mean, with pixels independent and channels wholly
/// dependent. Infinity for fewer than two passes.
double relative_error_of_mean(const core::Film& film);

/// worldToCamera of OpenEXR, 16 numbers: a left-handed camera space, matrices acting on row vectors.
std::string world_to_camera(const core::Camera& camera);

/// Two such texts, apart from rounding to float.
bool same_camera(const std::string& a, const std::string& b);

/// Hash of the scene's files and the definitions that change them: equal whatever integrator renders it.
std::string scene_content(const core::Scene& scene, std::vector<std::string> defines);

}  // namespace mote::apps
