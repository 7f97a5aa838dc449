#include "lights/selection/matrix/row_visibility.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr std::size_t map_lanes = ReceiverLanes::width;

/// View of a receiver: the side of its surface that it is seen from, or all directions.
ShadowMapView view_of(const ReceiverLanes& rows, int lane, int size) {
    const ScatteringVertex* vertex = rows.directional[lane];
    const bool both = vertex && vertex->on_surface() && vertex->bsdf->traits().transmissive;
    if (rows.in_medium[lane] != 0.0f || both) return ShadowMapView::of_point(rows.position(lane), size);
    return ShadowMapView::of_surface(rows.position(lane), rows.geometric_normal(lane), size);
}

}  // namespace

void RowMaps::build(const RayQueries& scene, const ReceiverTile& rows, const RowVisibilitySettings& settings,
                    CancelToken cancelled) {
    for (int i = 0; i < int(map_lanes); ++i) {
        if (rows.max_vpl_depth[i] == 0) continue;
        VolumetricShadowMap& map = maps_[std::size_t(i)];
        const ShadowMapView view = view_of(rows, i, settings.map_size);
        const ScatteringVertex* vertex = rows.directional[i];
        map.build(scene, view, vertex ? vertex->state_towards(rows.state[i], view.frame.n) : rows.state[i],
                  settings.map, cancelled);
        rays_.add(map.rays());
    }
}

void RowMaps::look_up(const VplSet& vpls, std::span<LaneLight> light) const {
    std::array<ShadowLookup, GatherScratch::batch / map_lanes> points{};
    const ReceiverLanes& rows = *light.front().receivers;
    for (std::size_t k = 0; k < points.size() * map_lanes; ++k) {
        const Vec3 p = vpls.lights[light[std::min(k, light.size() - 1)].vpl].position;
        points[k / map_lanes].x[k % map_lanes] = p.x, points[k / map_lanes].y[k % map_lanes] = p.y;
        points[k / map_lanes].z[k % map_lanes] = p.z;
    }
    for (std::size_t i = 0; i < map_lanes; ++i) {
        if (rows.max_vpl_depth[i] == 0) continue;
        maps_[i].look_up(points);
        for (std::size_t k = 0; k < light.size(); ++k) {
            const ShadowLookup& found = points[k / map_lanes];
            light[k].r[i] *= found.r[k % map_lanes], light[k].g[i] *= found.g[k % map_lanes];
            light[k].b[i] *= found.b[k % map_lanes];
        }
    }
}

}  // namespace mote::lights
