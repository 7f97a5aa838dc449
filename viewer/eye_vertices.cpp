#include "viewer/eye_vertices.h"

#include <nlohmann/json.hpp>

#include "integrators/eye_path/eye_path.h"

namespace mote::viewer {

namespace {

using nlohmann::json;

template <bool Media>
json vertices_of(const core::Scene& scene, const core::RenderOptions& options, const core::PassContext& pass,
                 int x, int y) {
    const integrators::EyeRay eye = integrators::make_eye_ray(scene, options, pass, x, y);
    core::WalkContext walk;
    walk.rng = eye.rng;
    integrators::EyePath<Media> path(scene, {}, eye, walk);
    integrators::TransportSum sum;
    json vertices = json::array();
    while (path.advance(walk, sum)) {
        const core::ScatteringVertex& v = path.vertex();
        vertices.push_back({{"position", numbers(v.position)},
                            {"film", film_position(scene, v.position)},
                            {"kind", v.on_surface() ? "surface" : "medium"},
                            {"segment", path.segment_length()},
                            {"throughput", numbers(path.throughput())}});
    }
    return vertices;
}

}  // namespace

json numbers(const core::Vec3& v) { return {v.x, v.y, v.z}; }

json film_position(const core::Scene& scene, const core::Vec3& p) {
    const auto film = scene.camera().project(p, 0.0f);
    return film ? json{film->x, film->y} : json();
}

json first_hit(const core::Scene& scene, int x, int y) {
    const core::Ray ray = scene.camera().sample_ray({float(x) + 0.5f, float(y) + 0.5f}, core::Vec2(0.5f));
    const auto hit = scene.first_hit(ray);
    if (!hit) return nullptr;
    const core::MediumState state = scene.eye_medium_state(ray);
    return {{"position", numbers(hit->position)},
            {"depth", hit->t},
            {"geometric_normal", numbers(hit->geometric_normal)},
            {"shading_normal", numbers(hit->shading.n)},
            {"shape", hit->shape->index + 1},
            {"in_medium", state.current() != nullptr}};
}

json eye_vertices(const core::Scene& scene, const core::RenderOptions& options, const core::PassContext& pass,
                  int x, int y) {
    return scene.attenuates() ? vertices_of<true>(scene, options, pass, x, y)
                              : vertices_of<false>(scene, options, pass, x, y);
}

}  // namespace mote::viewer
