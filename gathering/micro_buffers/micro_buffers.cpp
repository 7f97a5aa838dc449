#include "gathering/micro_buffers/micro_buffers.h"

#include <algorithm>

#include "core/objects/error.h"
#include "gathering/micro_buffers/group_walk.h"
#include "gathering/micro_buffers/warped_walk.h"

namespace mote::gathering {

using namespace core;

MicroBuffers::MicroBuffers(const PointHierarchy& hierarchy, const MicroBufferSettings& settings)
    : hierarchy_(hierarchy), settings_(settings), texels_(settings.side, settings.place) {
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

template <typename WeightOf>
Rgb weighted_sum(std::span<const MicroTexel> texels, const WeightOf& weight_of,
                 const NodeRadiance& radiance) {
    Vec3d sum(0.0);
    for (std::size_t i = 0; i < texels.size(); ++i)
        if (const MicroTexel& t = texels[i]; !t.empty())
            sum += Vec3d(Vec3(weight_of(i))) * Vec3d(radiance.of(t.node(), t.from_behind()));
    return Rgb(sum);
}

}  // namespace

Rgb gathered(std::span<const MicroTexel> texels, float weight, const NodeRadiance& radiance) {
    return weighted_sum(
        texels, [&](std::size_t) { return weight; }, radiance);
}

Rgb gathered(std::span<const MicroTexel> texels, std::span<const Rgb> weights, const NodeRadiance& radiance) {
    return weighted_sum(
        texels, [&](std::size_t i) { return weights[i]; }, radiance);
}

void gather_irradiance(const MicroBuffers& buffers, const NodeRadiance& radiance,
                       std::span<const MicroReceiver> receivers, std::span<Rgb> irradiance) {
    buffers.for_each(receivers, [&](std::size_t i, std::span<const MicroTexel> texels) {
        irradiance[i] = gathered(texels, buffers.texels().cosine_weight(), radiance);
    });
}

}  // namespace mote::gathering
