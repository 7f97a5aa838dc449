// In which media eye rays begin: a property of every ray, found once where all of them begin in the same.
#include "core/scene/scene.h"

namespace mote::core {

/// Where the picture's middle begins to be seen: a boundary nearer than that, or at the camera itself, is
/// never crossed.
Vec3 Scene::eye_start() const {
    const Ray middle = parts_.camera->sample_ray(
        0.5f * Vec2(float(parts_.film.width), float(parts_.film.height)), Vec2(0.5f));
    return middle.at(middle.t_min);
}

/// Pinholes see from a plane near them, lenses from around it, parallel projections from the whole picture.
void Scene::find_eye_states() {
    camera_state_ = medium_state_at(eye_start(), parts_.camera->medium.get());
    if (boundaries_.empty()) return;
    const float margin = parts_.film.filter_radius;  // filters reach beyond the picture
    Bounds3 starts;
    constexpr int steps = 8;  // on the lens, whose rim is a circle: the box is widened by more than it misses
    for (const float x : {-margin, float(parts_.film.width) + margin})
        for (const float y : {-margin, float(parts_.film.height) + margin})
            for (int i = 0; i <= steps; ++i)
                for (int j = 0; j <= steps; ++j) {
                    const Ray ray =
                        parts_.camera->sample_ray({x, y}, Vec2(float(i), float(j)) / float(steps));
                    starts.extend(ray.at(ray.t_min));
                }
    const Vec3 widened = 0.1f * starts.diagonal();
    starts.lower -= widened, starts.upper += widened;
    eyes_differ_ = any_boundary_in(starts, nullptr);
}

MediumState Scene::eye_medium_state(const Ray& ray) const {
    if (!eyes_differ_) return camera_state_;
    return medium_state_at(ray.at(ray.t_min), parts_.camera->medium.get());
}

}  // namespace mote::core
