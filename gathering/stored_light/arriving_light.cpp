#include "gathering/stored_light/arriving_light.h"

#include <tbb/parallel_for.h>

#include <limits>
#include <mutex>

#include "core/math/sampler.h"
#include "lights/direct_light/direct_light.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::size_t block = 256;  // places of a task: a multiple of the receivers of a tile

/// Calls fill(first, end, rays) for blocks of places.
template <typename Fill>
ArrivedLight at_all_places(std::size_t places, CancelToken cancelled, const Fill& fill) {
    ArrivedLight light;
    light.irradiance.assign(places, Rgb(0.0f));
    std::mutex mutex;
    tbb::parallel_for(std::size_t(0), (places + block - 1) / block, [&](std::size_t b) {
        cancelled.check();
        RayCounters rays;
        fill(b * block, std::min(places, (b + 1) * block), light.irradiance, rays);
        const std::lock_guard lock(mutex);
        light.rays.add(rays);
    });
    return light;
}

/// Irradiance by one light, sampled by both techniques.
Rgb sample_direct(const LitScene& scene, const ScatteringVertex& vertex, Sampler& sampler,
                  WalkContext& walk) {
    const PathWeights weights;
    const float u_light = sampler.next_1d();
    Rgb light = lights::sample_light<false>(scene, vertex, weights, {}, u_light, sampler.next_2d(), walk);
    if (const auto next = vertex.sample(0.5f, sampler.next_2d(), TransportMode::radiance))
        light += lights::light_towards<false>(scene, vertex, *next, weights, {}, walk);
    return pi * light;
}

}  // namespace

ArrivedLight direct_light_at(const LitScene& scene, const LightPlaces& places, int samples, std::uint64_t key,
                             CancelToken cancelled) {
    return at_all_places(
        places.size(), cancelled,
        [&](std::size_t first, std::size_t end, std::vector<Rgb>& irradiance, RayCounters& rays) {
            WalkContext walk;
            walk.cancelled = cancelled;
            for (std::size_t i = first; i < end; ++i) {
                const ScatteringVertex vertex = places.vertex(i);
                for (int k = 0; k < samples; ++k) {
                    Sampler sampler(SamplerKind::sobol, key, std::uint32_t(k), i);
                    walk.rng = sampler.make_rng();
                    irradiance[i] += sample_direct(scene, vertex, sampler, walk) / float(samples);
                }
            }
            rays = walk.rays;
        });
}

ArrivedLight vpl_light_at(const LitScene& scene, const LightPlaces& places, const lights::VplSet& vpls,
                          float bound, CancelToken cancelled) {
    constexpr std::size_t lanes = lights::ReceiverTile::width;
    static_assert(block % lanes == 0);
    return at_all_places(
        places.size(), cancelled,
        [&](std::size_t first, std::size_t end, std::vector<Rgb>& irradiance, RayCounters& rays) {
            const auto scratch = std::make_unique<lights::GatherScratch>();
            const auto tile = std::make_unique<lights::ReceiverTile>();
            TrackingCounters tracking;
            const lights::GatherContext context{scene, *scratch, rays, tracking, cancelled};
            for (std::size_t i = first; i < end; i += lanes) {
                tile->clear();
                const std::size_t count = std::min(lanes, end - i);
                for (std::size_t lane = 0; lane < count; ++lane)
                    tile->set(int(lane), places.vertex(i + lane), Rgb(pi), {}, Rng(i + lane),
                              std::numeric_limits<std::int32_t>::max());
                const auto light =
                    lights::gather(context, vpls, lights::VplRange{}, lights::BoundedGeometry{bound}, *tile);
                std::copy_n(light.begin(), count, irradiance.begin() + std::ptrdiff_t(i));
            }
        });
}

ArrivedLight photon_light_at(const LightPlaces& places, const SurfacePhotonMap& photons,
                             const DensityEstimate& estimate, CancelToken cancelled) {
    return at_all_places(places.size(), cancelled,
                         [&](std::size_t first, std::size_t end, std::vector<Rgb>& irradiance, RayCounters&) {
                             std::vector<KdTree::Neighbour> scratch;
                             for (std::size_t i = first; i < end; ++i)
                                 irradiance[i] =
                                     pi * photons.radiance(places.vertex(i), estimate,
                                                           std::numeric_limits<int>::max(), scratch);
                         });
}

}  // namespace mote::gathering
