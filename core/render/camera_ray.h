// The ray with which the eye path of a pixel starts in a pass: the first four numbers of its sampler choose
// the position on the film, through the pixel's filter, and the position on the lens.
//
// Eye paths of integrators begin here (integrators/eye_path/eye_ray.h), so code that needs the ray once more
// finds the very same one.
#pragma once

#include "core/math/sampler.h"
#include "core/render/integrator.h"
#include "core/scene/camera.h"

namespace mote::core {

/// The key of a pixel's random numbers.
inline std::uint64_t pixel_key(const RenderOptions& options, int x, int y) {
    return std::uint64_t(y) * std::uint64_t(options.width) + std::uint64_t(x);
}

/// The numbers of a pixel in a pass.
inline Sampler pixel_sampler(const RenderOptions& options, const PassContext& pass, int x, int y) {
    return Sampler(options.sampler, options.seed, pass.index, pixel_key(options, x, y));
}

/// An eye ray.
struct CameraRay {
    Ray ray;    ///< in the world
    Vec2 film;  ///< its position in the picture [pixels]
};

/// Samples from `sampler`, of which nothing has been used. `lens`: a point on the lens that all rays of a
/// pass share; null: every ray has its own.
inline CameraRay camera_ray(const Camera& camera, const PassContext& pass, int x, int y, Sampler& sampler,
                            const Vec2* lens = nullptr) {
    const Vec2 offset = pass.filter.sample_offset(sampler.next_2d());
    const Vec2 film = Vec2(float(x) + 0.5f, float(y) + 0.5f) + offset;
    return {camera.sample_ray(film, lens ? *lens : sampler.next_2d()), film};
}

/// The ray of a pixel in a pass.
inline Ray camera_ray(const Camera& camera, const RenderOptions& options, const PassContext& pass, int x,
                      int y) {
    Sampler sampler = pixel_sampler(options, pass, x, y);
    const Vec2i pixel = options.columns.at(x, y);
    return camera_ray(camera, pass, pixel.x, pixel.y, sampler).ray;
}

}  // namespace mote::core
