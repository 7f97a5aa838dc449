// Motion of the points that a picture shows since the frame before, as features of the first hit: input of
// denoisers of sequences.
#pragma once

#include <memory>
#include <vector>

#include "core/render/first_hit_features.h"
#include "core/scene/scene.h"

namespace mote::core {

/// Camera and shapes of the frame before.
class PreviousFrame {
  public:
    /// Keeps the scene's camera and shapes, and nothing of their materials, lights and media: it must be the
    /// scene's only owner.
    explicit PreviousFrame(std::shared_ptr<Scene> scene);

    const Camera& camera() const { return *camera_; }
    /// For every shape of `scene` the same shape in that frame, or null: the one with the same place in the
    /// scene, or, where shapes came or went, the one with the same id.
    std::vector<const Shape*> counterparts(const Scene& scene) const;

  private:
    std::shared_ptr<const Camera> camera_;
    std::vector<std::shared_ptr<Shape>> shapes_;
};

/// A motion vector that leads out of every picture: the point was not there, or not in front of the camera.
inline constexpr float not_seen_before = 1e6f;

/// MotionVector: from where the point is seen to where it was seen in the frame before, in pixels to the
/// right and down, both through the middle of the lens. PreviousP: where the point was [m], or P where it was
/// not there. Means over the rays that hit a surface. `scene` and `before` must outlive the features.
std::vector<HitFeature> motion_features(const Scene& scene, const PreviousFrame& before);

}  // namespace mote::core
