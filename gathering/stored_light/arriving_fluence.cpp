#include "gathering/stored_light/arriving_fluence.h"

#include <tbb/parallel_for.h>

#include <mutex>

#include "core/math/sampler.h"
#include "lights/direct_light/direct_light.h"
#include "media/phase_functions.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::size_t points_of_task = 256;

/// One estimate by both techniques. Light from a direction is what an isotropic vertex scatters of it, times
/// 4 pi.
void add_direct(const LitScene& scene, const ScatteringVertex& vertex, const MediumState& state, float share,
                Sampler& sampler, WalkContext& walk, Fluence& sum) {
    PathWeights weights;
    weights.hero = draw_hero(walk.rng);
    const LightChoice choice = scene.choose_light(vertex.light_receiver(), sampler.next_1d());
    const Vec2 u = sampler.next_2d();
    if (choice.emitter) {
        // The same u is the same place on the light.
        if (const auto sample = choice.emitter->sample_direct(vertex.position, u))
            sum.add(lights::connect_light<true>(scene, vertex, weights, state, choice, u, walk), sample->wi,
                    4.0f * pi * share);
    }
    if (const auto next = vertex.sample(0.5f, sampler.next_2d(), TransportMode::radiance))
        sum.add(lights::light_towards<true>(scene, vertex, *next, weights, state, walk), next->wi,
                4.0f * pi * share);
}

}  // namespace

ArrivedFluence direct_fluence_at(const LitScene& scene, const VolumePoints& points, int samples,
                                 std::uint64_t key, CancelToken cancelled) {
    ArrivedFluence light;
    light.fluence.resize(points.size());
    const media::IsotropicPhase isotropic;
    std::mutex mutex;
    tbb::parallel_for(std::size_t(0), (points.size() + points_of_task - 1) / points_of_task,
                      [&](std::size_t task) {
                          cancelled.check();
                          WalkContext walk;
                          walk.cancelled = cancelled;
                          const std::size_t end = std::min(points.size(), (task + 1) * points_of_task);
                          for (std::size_t i = task * points_of_task; i < end; ++i) {
                              ScatteringVertex vertex;
                              vertex.position = points.positions[i], vertex.wo = Vec3(0.0f, 0.0f, 1.0f);
                              vertex.phase = &isotropic;
                              for (int k = 0; k < samples; ++k) {
                                  Sampler sampler(SamplerKind::sobol, key, std::uint32_t(k), i);
                                  walk.rng = sampler.make_rng();
                                  add_direct(scene, vertex, points.states[i], 1.0f / float(samples), sampler,
                                             walk, light.fluence[i]);
                              }
                          }
                          const std::lock_guard lock(mutex);
                          light.rays.add(walk.rays), light.tracking.add(walk.tracking);
                      });
    return light;
}

}  // namespace mote::gathering
