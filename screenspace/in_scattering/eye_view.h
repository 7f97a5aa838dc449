// View that eye rays are marched from: a camera, the media where its rays begin, and the extent of the media
// that scatter. Made from a Scene, or given by another renderer.
#pragma once

#include <functional>

#include "core/math/bounds.h"
#include "core/math/ray.h"
#include "core/scene/medium_state.h"

namespace mote::core {
class Camera;
class Scene;
}  // namespace mote::core

namespace mote::screenspace {

/// A camera in its surroundings. Keeps a reference to the camera.
struct EyeView {
    const core::Camera& camera;  ///< of the picture
    std::function<core::MediumState(const core::Ray&)>
        media;  ///< at ray.t_min of an eye ray, from any thread
};

/// View of a scene, which must outlive it.
EyeView eye_view(const core::Scene& scene);

/// Holds every point where a medium can scatter light; all of space where one does so outside of all shapes.
core::Bounds3 scattering_extent(const core::Scene& scene);

}  // namespace mote::screenspace
