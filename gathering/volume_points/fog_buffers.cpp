#include "gathering/volume_points/fog_buffers.h"

#include "core/objects/error.h"
#include "gathering/volume_points/fog_walk.h"

namespace mote::gathering {

using namespace core;

FogBuffers::FogBuffers(const MicroBuffers& surfaces, const VolumeHierarchy& volume,
                       const ExtinctionGrid& extinction, float cut)
    : surfaces_(surfaces), volume_(volume), extinction_(extinction), cut_(cut) {
    if (!(cut > 0.0f)) throw InputError("the cut of volume points must be positive");
    const HemisphereTexels& texels = surfaces.texels();
    rays_.resize(texels.side());
    for (std::uint32_t i = 0; i < texels.count(); ++i) rays_.set(i, texels.directions()[i]);
}

void FogBuffers::render(std::span<const MicroReceiver> receivers, const NodeRadiance& surfaces,
                        const VolumeLight& volume, std::span<Rgb> radiance, FogScratch& scratch,
                        const Rgb& environment) const {
    const std::uint32_t each = texels_each(), side = surfaces_.texels().side();
    const HemisphereMap map = surfaces_.texels().map();
    scratch.texels.resize(receivers.size() * each);
    surfaces_.render(receivers, scratch.texels);
    scratch.depths.emplace(extinction_, map, side);
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const MicroTexel* texels = scratch.texels.data() + r * each;
        for (auto* row : {&scratch.distance, &scratch.red, &scratch.green, &scratch.blue})
            row->assign(each + RayDirections::lanes, 0.0f);
        for (std::uint32_t i = 0; i < each; ++i) scratch.distance[i] = texels[i].distance;
        scratch.depths->march(receivers[r]);
        walk_fog({volume_, volume, rays_, map, cut_}, receivers[r], scratch);
        for (std::uint32_t i = 0; i < each; ++i) {
            const MicroTexel& t = texels[i];
            const Rgb& behind = t.empty() ? environment : surfaces.of(t.node(), t.from_behind());
            radiance[r * each + i] = Rgb(scratch.red[i], scratch.green[i], scratch.blue[i]);
            if (!is_black(behind))
                radiance[r * each + i] +=
                    behind * scratch.depths->transmittance(i % side, i / side, t.distance);
        }
    }
}

}  // namespace mote::gathering
