#include "lights/shadow_maps/shadow_map_gather.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

void ReceiverStore::add(const ReceiverLanes& receivers, int column, int row, const VplRange& range,
                        float scale) {
    if (!receivers.any_active) return;
    Tile& tile = tiles_.emplace_back();
    static_cast<ReceiverLanes&>(tile) = receivers;
    tile.column = column, tile.row = row, tile.range = range;
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

void ShadowMapGather::look_up(const ReceiverStore& store, const VplSet& vpls, float bound,
                              const MappedVpl& light) {
    tiles_.clear(), points_.clear();
    contributions_.resize(store.tiles().size());
    for (const ReceiverStore::Tile& tile : store.tiles()) {
        const VplRange& range = tile.range;
        if (light.index < range.first || light.index >= range.end ||
            (light.index - range.first) % range.stride != 0)
            continue;
        if (!connect(tile, vpls, vpls.lights[light.index], bound, packet_, contributions_[points_.size()]))
            continue;
        ShadowLookup& points = points_.emplace_back();
        std::copy_n(tile.x, ReceiverLanes::width, points.x);
        std::copy_n(tile.y, ReceiverLanes::width, points.y);
        std::copy_n(tile.z, ReceiverLanes::width, points.z);
        tiles_.push_back(&tile);
    }
    light.map->look_up(points_);
    lookups_ += points_.size() * ShadowLookup::width;
}

}  // namespace mote::lights
