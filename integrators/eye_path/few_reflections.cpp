#include "integrators/eye_path/few_reflections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/bsdf_point.h"
#include "core/geometry/shape.h"
#include "core/materials/bsdf.h"
#include "core/math/frame.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/objects/error.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr double max_missing = 0.5;  ///< of the light between surfaces
constexpr std::size_t rays_of_all = 8192;
constexpr std::size_t max_shapes = 1024;  ///< that rays start from; more are left out evenly

/// True where the surface reflects all that it does not absorb, and not in one direction alone: mirrors and
/// glass are passed by eye paths and light paths.
bool reflects(const Shape& shape) {
    const BsdfTraits traits = shape.bsdf->traits();
    return !traits.null && !traits.transmissive && traits.smooth;
}

/// Albedo of a shape at the end of a ray, 0 where the light is lost.
double albedo_at(const Scene& scene, const Ray& ray) {
    const auto hit = scene.first_hit(ray);
    if (!hit || !reflects(*hit->shape)) return 0.0;
    return double(average(hit->shape->bsdf->albedo(bsdf_point(*hit), hit->shading.to_local(-ray.direction))));
}

/// Mean of what surfaces reflect of the light that leaves a shape by the cosine, on the side where that is
/// more: a board may reflect on one side only.
double next_albedo(const Scene& scene, const Shape& shape, std::size_t rays, std::uint64_t key) {
    double sides[2] = {0.0, 0.0};
    Rng rng(key);
    for (std::size_t i = 0; i < rays; ++i) {
        const ShapeSample from = shape.sample_area({rng.next_float(), rng.next_float()});
        const Vec3 up = square_to_cosine_hemisphere({rng.next_float(), rng.next_float()});
        for (const int side : {0, 1}) {
            const Vec3 direction = Frame(side == 0 ? from.normal : -from.normal).to_world(up);
            sides[side] += albedo_at(
                scene, {offset_origin(from.position, from.normal, from.error, direction), direction});
        }
    }
    return std::max(sides[0], sides[1]) / double(rays);
}

/// Share of the light between surfaces that the next surface reflects: by rays from all of them, by area.
double mean_reflectance(const Scene& scene) {
    double area = 0.0, reflecting = 0.0;
    const auto& shapes = scene.shapes();
    const std::size_t stride = std::max<std::size_t>(1, shapes.size() / max_shapes);
    const std::size_t rays = rays_of_all / std::min(std::max<std::size_t>(1, shapes.size()), max_shapes);
    for (std::size_t i = 0; i < shapes.size(); i += stride) {
        const double own = double(shapes[i]->area());
        if (!reflects(*shapes[i]) || !(own > 0.0) || !std::isfinite(own)) continue;
        area += own, reflecting += own * next_albedo(scene, *shapes[i], rays, hash_keys(0x7265666cull, i));
    }
    return area > 0.0 ? reflecting / area : 0.0;
}

}  // namespace

double light_of_more_reflections(const Scene& scene, int reflections) {
    return std::pow(std::min(mean_reflectance(scene), 1.0), double(reflections));
}

void require_reflections(const Scene& scene, int reflections, const std::string& integrator,
                         const std::string& remedy) {
    const double missing = light_of_more_reflections(scene, reflections);
    if (missing > max_missing)
        throw InputError(fmt::format(
            "{} follows {} reflections, and about {:.0f} % of the light between these surfaces has more: {}",
            integrator, reflections, 100.0 * missing, remedy));
}

}  // namespace mote::integrators
