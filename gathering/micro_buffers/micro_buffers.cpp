#include "gathering/micro_buffers/micro_buffers.h"

#include <algorithm>

#include "core/objects/error.h"
#include "gathering/micro_buffers/group_walk.h"
#include "gathering/micro_buffers/warped_walk.h"

namespace mote::gathering {

using namespace core;

MicroBuffers::MicroBuffers(const PointHierarchy& hierarchy, const MicroBufferSettings& settings)
    : hierarchy_(hierarchy),
      settings_(settings),
      texels_(settings.map, settings.side * settings.rays, settings.place) {
    rays_.resize(texels_.side());
    for (std::uint32_t i = 0; i < texels_.count(); ++i) rays_.set(i, texels_.directions()[i]);

    if (settings.rays == 0) throw InputError("a texel of micro-buffers needs rays");
    if (!(settings.cut > 0.0f)) throw InputError("the cut of micro-buffers must be positive");
}

void MicroBuffers::render(std::span<const MicroReceiver> receivers, std::span<MicroTexel> texels) const {
    const std::size_t stride = texels_each() + RayDirections::lanes;
    std::vector<float> distances(ReceiverLanes::width * stride);
    std::vector<std::uint32_t> hits(ReceiverLanes::width * stride);
    for (std::size_t begin = 0; begin < receivers.size(); begin += ReceiverLanes::width) {
        const std::size_t count = std::min<std::size_t>(ReceiverLanes::width, receivers.size() - begin);
        std::fill(distances.begin(), distances.end(), infinity);
        std::fill(hits.begin(), hits.end(), MicroTexel::nothing);
        walk_group(hierarchy_, settings_, rays_, receivers.subspan(begin, count), stride, distances.data(),
                   hits.data());
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < texels_each(); ++k)
                texels[(begin + i) * texels_each() + k] = {distances[i * stride + k], hits[i * stride + k]};
    }
}

void MicroBuffers::render_warped(std::span<const MicroReceiver> receivers, std::span<const BrdfWarp> warps,
                                 std::span<MicroTexel> texels) const {
    std::vector<float> distances(texels_each() + RayDirections::lanes);
    std::vector<std::uint32_t> hits(distances.size());
    RayDirections rays;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        std::fill(distances.begin(), distances.end(), infinity);
        std::fill(hits.begin(), hits.end(), MicroTexel::nothing);
        warps[i].fill_directions(texels_.side(), settings_.place, rays);
        walk_warped(hierarchy_, settings_, warps[i], rays, receivers[i], {distances.data(), hits.data()});
        for (std::size_t k = 0; k < texels_each(); ++k)
            texels[i * texels_each() + k] = {distances[k], hits[k]};
    }
}

namespace {

template <typename Weight>
Rgb weighted_sum(std::span<const MicroTexel> texels, std::span<const Weight> weights,
                 const NodeRadiance& radiance, const Rgb& environment) {
    Vec3d sum(0.0);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const MicroTexel& t = texels[i];
        const Rgb& seen = t.empty() ? environment : radiance.of(t.node(), t.from_behind());
        sum += Vec3d(Vec3(weights[i])) * Vec3d(seen);
    }
    return Rgb(sum);
}

}  // namespace

Rgb gathered(std::span<const MicroTexel> texels, std::span<const float> weights, const NodeRadiance& radiance,
             const Rgb& environment) {
    return weighted_sum(texels, weights, radiance, environment);
}

Rgb gathered(std::span<const MicroTexel> texels, std::span<const Rgb> weights, const NodeRadiance& radiance,
             const Rgb& environment) {
    return weighted_sum(texels, weights, radiance, environment);
}

void gather_irradiance(const MicroBuffers& buffers, const NodeRadiance& radiance,
                       std::span<const MicroReceiver> receivers, std::span<Rgb> irradiance,
                       const Rgb& environment) {
    buffers.for_each(receivers, [&](std::size_t i, std::span<const MicroTexel> texels) {
        irradiance[i] = gathered(texels, buffers.texels().cosine_weights(), radiance, environment);
    });
}

}  // namespace mote::gathering
