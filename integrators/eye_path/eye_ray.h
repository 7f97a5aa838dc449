// The start of every eye path: the sampler and the camera ray of a pixel in a pass.
#pragma once

#include "core/render/camera_ray.h"
#include "core/scene/scene.h"

namespace mote::integrators {

struct EyeRay {
    core::Ray ray;
    core::Vec2 film;        ///< its place in the picture [pixels]
    core::Sampler sampler;  ///< its first dimensions have been used for film and lens
    core::Rng rng;          ///< for tracking and roulette
};

/// `lens`: a point on the lens that all rays of a pass share; null: every ray has its own.
inline EyeRay make_eye_ray(const core::Scene& scene, const core::RenderOptions& options,
                           const core::PassContext& pass, int x, int y, const core::Vec2* lens = nullptr) {
    core::Sampler sampler = core::pixel_sampler(options, pass, x, y);
    core::Rng rng = sampler.make_rng();
    const core::Vec2i pixel = options.columns.at(x, y);
    const auto [ray, film] = core::camera_ray(scene.camera(), pass, pixel.x, pixel.y, sampler, lens);
    return {ray, film, sampler, rng};
}

}  // namespace mote::integrators
