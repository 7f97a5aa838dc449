#include "integrators/bidirectional/subpath.h"

#include "core/scene/media_along.h"

namespace mote::integrators {

using namespace core;

double density_of_previous(const Subpath& path, std::size_t k, const Vec3& from, TransportMode mode,
                           bool delta) {
    return density_of_previous(path.vertices[k], path.vertices[k - 1], from, mode, delta);
}

double density_of_previous(const PathVertex& vertex, const PathVertex& previous, const Vec3& from,
                           TransportMode mode, bool delta) {
    const double pdf = delta ? 1.0 : double(reverse_pdf_solid_angle(vertex.scattering, from, mode));
    return pdf * previous.area_measure(vertex.scattering.wo, vertex.distance_squared) * vertex.edge;
}

double edge_transmittance(const RayQueries& scene, const Ray& ray, const MediumState& state,
                          TrackingCounters& counters) {
    constexpr float voxels = 16.0f;
    constexpr double deepest = 40.0;
    if (!scene.has_media()) return 1.0;
    Vec3d depth(0.0);
    const auto medium = [&](float t0, float t1, const MediumState& here) {
        const Medium* m = here.current();
        if (m && t0 < t1)
            depth += m->optical_depth_along({ray.origin, ray.direction, t0, t1}, voxels, counters);
        return true;
    };
    for_each_part(scene, ray, state, medium, [](const SurfaceHit&) { return true; });
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) sum += std::isfinite(depth[c]) ? std::exp(-std::min(depth[c], deepest)) : 1.0;
    return sum / 3.0;
}

Ray segment_between(const ScatteringVertex& a, const ScatteringVertex& b, const Vec3& direction) {
    const Vec3 from = a.ray_origin(direction), to = b.ray_origin(-direction);
    const Vec3 d = to - from;
    const float length = glm::length(d);
    if (!(length > 0.0f)) return {from, direction, 0.0f, 0.0f};
    return {from, d / length, 0.0f, length};
}

}  // namespace mote::integrators
