#include "screenspace/epipolar/epipolar_projection.h"

namespace mote::screenspace {

using namespace core;

FilmProjection::FilmProjection(const Camera& camera, int width, int height, const Vec2& u_lens)
    : to_camera_(camera.to_world().inverse()) {
    struct Local {
        Vec3d origin, direction;  // in camera space; direction.z = 1
    };
    const auto local = [&](int x, int y) {
        const Ray ray = camera.sample_ray(Vec2(float(x), float(y)), u_lens);
        const Vec3d d = to_camera_.vector(Vec3d(ray.direction));
        return Local{to_camera_.point(Vec3d(ray.origin)), d / d.z};
    };
    const Local corner = local(0, 0), right = local(width, 0), down = local(0, height);
    const double w = width, h = height;
    origin_ = corner.origin;
    parallel_ =
        glm::length(right.origin - corner.origin) > 1e-9 * glm::length(right.direction - corner.direction);
    // A point is origin + z direction(x, y), linear in (z, zx, zy) or, for parallel rays, in (z, x, y).
    const glm::dmat3 camera_from_film =
        parallel_ ? glm::dmat3(corner.direction, (right.origin - corner.origin) / w,
                               (down.origin - corner.origin) / h)
                  : glm::dmat3(corner.direction, (right.direction - corner.direction) / w,
                               (down.direction - corner.direction) / h);
    film_from_camera_ = glm::inverse(camera_from_film);
}

FilmPoint FilmProjection::project(const Vec3d& point, double nearest) const {
    const Vec3d from_eye = to_camera_.point(point) - origin_;
    const Vec3d film = film_from_camera_ * from_eye;
    if (parallel_) return {film.y, film.z, 1.0};
    if (glm::length(from_eye) <= nearest) return {};
    return {film.y, film.z, film.x};
}

}  // namespace mote::screenspace
