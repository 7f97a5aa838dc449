#include "integrators/eye_path/few_reflections.h"

#include <fmt/format.h>

#include <cmath>

#include "core/geometry/shape.h"
#include "core/materials/bsdf.h"
#include "core/objects/error.h"
#include "core/scene/emitter.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr double max_missing = 0.5;  ///< of the light between surfaces

/// Mean albedo of a shape, at a grid of points.
double mean_albedo(const Shape& shape) {
    constexpr int side = 4;
    double sum = 0.0;
    for (int i = 0; i < side * side; ++i) {
        const Vec2 u((float(i % side) + 0.5f) / float(side), (float(i / side) + 0.5f) / float(side));
        BsdfPoint point;
        point.uv = shape.sample_area(u).uv;
        sum += double(average(shape.bsdf->albedo(point, Vec3(0.0f, 0.0f, 1.0f))));
    }
    return sum / double(side * side);
}

double mean_reflectance(const Scene& scene) {
    double area = 0.0, reflecting = 0.0;
    for (const auto& shape : scene.shapes()) {
        const double own = double(shape->area());
        if (shape->bsdf->traits().null || !(own > 0.0) || !std::isfinite(own)) continue;
        area += own, reflecting += own * mean_albedo(*shape);
    }
    return area > 0.0 ? reflecting / area : 0.0;
}

}  // namespace

double light_of_more_reflections(const Scene& scene, int reflections) {
    for (const auto& emitter : scene.emitters())
        if (emitter->traits().infinite) return 0.0;
    return std::pow(mean_reflectance(scene), double(reflections));
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
