#include "gathering/stored_light/fog_radiosity.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/math/warp.h"
#include "gathering/stored_light/micro_receiver.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::size_t receivers_of_task = 16;

/// Renders all receivers, and calls visit(i, radiance) for each.
template <typename Visit>
void gather_all(const FogBuffers& buffers, std::span<const MicroReceiver> receivers,
                const NodeRadiance& surfaces, const VolumeLight& volume, CancelToken cancelled,
                const Visit& visit) {
    const std::size_t each = buffers.texels_each();
    tbb::parallel_for(
        std::size_t(0), (receivers.size() + receivers_of_task - 1) / receivers_of_task, [&](std::size_t t) {
            cancelled.check();
            const std::size_t begin = t * receivers_of_task,
                              count = std::min(receivers_of_task, receivers.size() - begin);
            std::vector<Rgb> radiance(count * each);
            FogScratch scratch;
            buffers.render(receivers.subspan(begin, count), surfaces, volume, radiance, scratch);
            for (std::size_t i = 0; i < count; ++i)
                visit(begin + i, std::span<const Rgb>(radiance).subspan(i * each, each));
        });
}

struct Gatherers {
    std::vector<MicroReceiver> places, points;  ///< of points two each
    GatheringPlaces of_places;
};

Gatherers find_gatherers(const FogExchange& between, std::uint32_t volume_level,
                         const PointRadiositySettings& settings) {
    Gatherers g;
    g.of_places = gathering_places(between.surface_hierarchy, between.sides, settings.level);
    for (const std::uint32_t place : g.of_places.gather)
        g.places.push_back(
            micro_receiver(between.sides.vertex(place), Rng(hash_keys(settings.key, place)).next_float()));
    const PointHierarchy& tree = between.volume_hierarchy.tree();
    const std::uint32_t step = 1u << volume_level;
    for (std::uint32_t first = 0; first < tree.points(); first += step) {
        const std::uint32_t middle = first + std::min(step, tree.points() - first) / 2;
        Rng rng(hash_keys(settings.key, 0x666f67ull, first));
        const Vec2 u = rng.next_vec2();
        for (const MicroReceiver& r :
             sphere_receivers(between.points.positions[tree.order()[middle]], u, rng.next_float()))
            g.points.push_back(r);
    }
    return g;
}

}  // namespace

std::array<MicroReceiver, 2> sphere_receivers(const Vec3& position, const Vec2& u, float turn) {
    const Frame any(square_to_sphere(u));
    const float c = std::cos(2.0f * pi * turn), s = std::sin(2.0f * pi * turn);
    const Vec3 along = c * any.s + s * any.t;
    return {MicroReceiver{position, Frame(any.n, along)}, MicroReceiver{position, Frame(-any.n, along)}};
}

Fluence gathered_fluence(const HemisphereTexels& texels, const Frame& frame, std::span<const Rgb> radiance) {
    Fluence sum;
    const auto solid_angles = texels.solid_angles();
    for (std::size_t i = 0; i < texels.count(); ++i)
        sum.add(radiance[i], frame.to_world(texels.directions()[i]), solid_angles[i]);
    return sum;
}

FogLight fog_radiosity(const FogExchange& between, FogLight arriving, std::uint32_t volume_level,
                       const PointRadiositySettings& settings) {
    if (settings.bounces == 0) return arriving;
    const Gatherers g = find_gatherers(between, volume_level, settings);
    const PointHierarchy& tree = between.volume_hierarchy.tree();
    const auto cosines = between.hemispheres.surfaces().texels().cosine_weights();
    FogLight light = arriving;
    std::vector<Rgb> irradiance(g.places.size());
    std::vector<Fluence> halves(g.points.size());
    for (int bounce = 0; bounce < settings.bounces; ++bounce) {
        const SurfelSides::Radiance sent = between.sides.reflected(light.irradiance);
        const NodeRadiance surfaces(between.surface_hierarchy, sent.front, sent.back);
        const VolumeLight volume(between.volume_hierarchy, between.points, light.fluence);
        gather_all(between.hemispheres, g.places, surfaces, volume, settings.cancelled,
                   [&](std::size_t i, std::span<const Rgb> radiance) {
                       irradiance[i] = weighted(radiance, cosines);
                   });
        gather_all(between.spheres, g.points, surfaces, volume, settings.cancelled,
                   [&](std::size_t i, std::span<const Rgb> radiance) {
                       halves[i] =
                           gathered_fluence(between.spheres.surfaces().texels(), g.points[i].frame, radiance);
                   });
        for (std::size_t i = 0; i < light.irradiance.size(); ++i)
            light.irradiance[i] = arriving.irradiance[i] + irradiance[g.of_places.by[i]];
        for (std::uint32_t leaf = 0; leaf < tree.points(); ++leaf) {
            const std::size_t by = std::size_t(leaf >> volume_level), i = tree.order()[leaf];
            light.fluence[i] = arriving.fluence[i] + halves[2 * by] + halves[2 * by + 1];
        }
    }
    return light;
}

}  // namespace mote::gathering
