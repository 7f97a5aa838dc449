#include "gathering/micro_buffers/micro_buffers.h"

#include <algorithm>

#include "core/objects/error.h"
#include "gathering/micro_buffers/group_walk.h"

namespace mote::gathering {

using namespace core;

MicroBuffers::MicroBuffers(const PointHierarchy& hierarchy, const MicroBufferSettings& settings)
    : hierarchy_(hierarchy), settings_(settings), texels_(settings.map, settings.side * settings.rays) {
    rays_.resize(texels_.side());
    for (std::uint32_t i = 0; i < texels_.count(); ++i) rays_.set(i, texels_.directions()[i]);

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

Rgb gathered(std::span<const MicroTexel> texels, std::span<const float> weights, const NodeRadiance& radiance,
             const Rgb& environment) {
    Vec3d sum(0.0);
    for (std::size_t i = 0; i < texels.size(); ++i)
        sum +=
            double(weights[i]) *
            Vec3d(texels[i].empty() ? environment : radiance.of(texels[i].node(), texels[i].from_behind()));
    return Rgb(sum);
}

void gather_irradiance(const MicroBuffers& buffers, const NodeRadiance& radiance,
                       std::span<const MicroReceiver> receivers, std::span<Rgb> irradiance,
                       const Rgb& environment) {
    buffers.for_each(receivers, [&](std::size_t i, std::span<const MicroTexel> texels) {
        irradiance[i] = gathered(texels, buffers.texels().cosine_weights(), radiance, environment);
    });
}

}  // namespace mote::gathering
