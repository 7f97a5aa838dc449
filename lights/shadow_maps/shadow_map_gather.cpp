#include "lights/shadow_maps/shadow_map_gather.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

void ReceiverStore::add(const ReceiverLanes& receivers, int column, int row, int spacing,
                        const VplRange& range, float scale) {
    if (!receivers.any_active) return;
    Tile& tile = tiles_.emplace_back();
    static_cast<ReceiverLanes&>(tile) = receivers;
    tile.column = column, tile.row = row, tile.spacing = spacing, tile.range = range;
    for (int i = 0; i < ReceiverLanes::width; ++i) {
        tile.weight_r[i] *= scale, tile.weight_g[i] *= scale, tile.weight_b[i] *= scale;
        if (receivers.max_vpl_depth[i] > 0) ++receivers_;
        if (receivers.directional[i])
            tile.directional[i] = &vertices_.emplace_back(*receivers.directional[i]);
    }
}

void ReceiverStore::clear() {
    tiles_.clear(), vertices_.clear();
    receivers_ = 0;
}

VplViews views_of(const VplSet& vpls, std::size_t index, int size) {
    const VirtualPointLight& vpl = vpls.lights[index];
    if (!vpl.on_surface()) return {{ShadowMapView::of_point(vpl.position, size), {}}, 1};
    const auto front = ShadowMapView::of_surface(vpl.position, vpl.normal, size);
    const bool both = vpl.detail != VirtualPointLight::no_detail &&
                      vpls.details[vpl.detail].vertex.bsdf->traits().transmissive;
    if (!both) return {{front, {}}, 1};
    const Vec3 behind = vpls.details[vpl.detail].vertex.ray_origin(-vpl.normal);
    return {{front, ShadowMapView::of_surface(behind, -vpl.normal, size)}, 2};
}

void MappedVisibility::operator()(std::span<ShadowPacket>, std::span<LaneLight> light) {
    std::array<ShadowLookup, GatherScratch::batch> points;
    for (std::size_t k = 0; k < light.size(); ++k) {
        const ReceiverLanes& receivers = *light[k].receivers;
        std::copy_n(receivers.x, ReceiverLanes::width, points[k].x);
        std::copy_n(receivers.y, ReceiverLanes::width, points[k].y);
        std::copy_n(receivers.z, ReceiverLanes::width, points[k].z);
    }
    map_.look_up(std::span(points).first(light.size()));
    lookups_ += light.size() * ShadowLookup::width;
    for (std::size_t k = 0; k < light.size(); ++k)
        for (int i = 0; i < ReceiverLanes::width; ++i) {
            LaneLight& l = light[k];
            l.r[i] *= points[k].r[i], l.g[i] *= points[k].g[i], l.b[i] *= points[k].b[i];
        }
}

}  // namespace mote::lights
