#include "media/sampled_medium.h"

#include "core/objects/error.h"
#include "media/constant_volume.h"
#include "media/grid_volume.h"
#include "media/phase_functions.h"
#include "media/vol_file.h"

namespace mote::media {

using core::Vec3;

std::shared_ptr<core::Medium> sampled_medium(const ExtinctionFunction& extinction, const core::Bounds3& box,
                                             int resolution, const core::Rgb& albedo,
                                             std::shared_ptr<core::PhaseFunction> phase) {
    if (resolution < 1 || resolution > 2048)
        throw core::InputError("a sampled medium has 1 to 2048 voxels an axis");
    if (box.empty()) throw core::InputError("a sampled medium needs a box");
    if (core::max_component(albedo) > 1.0f) throw core::InputError("an albedo above 1");
    VolFile voxels;
    voxels.resolution = glm::ivec3(resolution), voxels.bounds = box;
    voxels.values.reserve(std::size_t(resolution) * std::size_t(resolution) * std::size_t(resolution));
    for (int z = 0; z < resolution; ++z)
        for (int y = 0; y < resolution; ++y)
            for (int x = 0; x < resolution; ++x) {
                const Vec3 centre = (Vec3(x, y, z) + 0.5f) / float(resolution);
                const float value = extinction(box.lower + centre * box.diagonal());
                if (!(value >= 0.0f) || !std::isfinite(value))
                    throw core::InputError("an extinction that is negative or not finite");
                voxels.values.push_back(value);
            }
    const GridVolume grid(std::move(voxels), core::Transform{}, true, "sampled");
    MediumParts parts;
    parts.albedo = std::make_shared<ConstantVolume>(albedo);
    parts.phase = phase ? std::move(phase) : std::make_shared<IsotropicPhase>();
    return grid.make_medium(std::move(parts));
}

}  // namespace mote::media
