// What a picture says about itself so that others can be judged by it: of which scene and camera it is.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace mote::apps {

/// worldToCamera of OpenEXR, 16 numbers: a left-handed camera space, matrices acting on row vectors.
std::string world_to_camera(const core::Camera& camera);

/// Two such texts, apart from rounding to float.
bool same_camera(const std::string& a, const std::string& b);

/// Hash of the scene's files and the definitions that change them: equal whatever integrator renders it.
std::string scene_content(const core::Scene& scene, std::vector<std::string> defines);

}  // namespace mote::apps
