#include "gathering/stored_light/lit_points.h"

#include "core/math/random.h"
#include "gathering/photon_maps/photon_tracer.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::gathering {

using namespace core;

namespace {

Surfels draw_points(const SurfaceTriangles& surfaces, const LitPointSettings& settings, std::uint64_t key,
                    CancelToken cancelled) {
    SurfelSettings s;
    s.seed = key, s.memory_budget = settings.memory_budget, s.cancelled = cancelled;
    if (settings.candidates == 0) return stratified_surfels(surfaces, settings.points, s);
    s.candidates = settings.candidates;
    return blue_noise_surfels(surfaces, settings.points, s);
}

/// Another one every pass, which together are even (Roberts' sequence: multiples of the powers of one over
/// the plastic number).
Vec2 ray_place(std::uint64_t key, std::uint32_t pass) {
    Rng rng(key);
    const double x = double(rng.next_float()) + 0.7548776662466927 * pass,
                 y = double(rng.next_float()) + 0.5698402909980532 * pass;
    return glm::min(Vec2(float(x - std::floor(x)), float(y - std::floor(y))), Vec2(one_minus_epsilon));
}

void add(std::vector<Rgb>& sum, const std::vector<Rgb>& more) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}

}  // namespace

void LitPoints::check_memory(const LitPointSettings& settings, bool media) {
    SurfelSettings s;
    s.memory_budget = settings.memory_budget, s.candidates = settings.candidates;
    check_surfel_memory(settings.points, s, settings.candidates > 0);
    PointHierarchy::check_memory(settings.points, settings.memory_budget);
    if (media) LitVolume::check_memory(settings.volume.points, settings.memory_budget);
}

LitPoints::LitPoints(const LitScene& scene, const SurfaceTriangles& surfaces, ShapeSpan shapes,
                     const LitPointSettings& settings, const MicroBufferSettings& buffers, std::uint64_t seed,
                     std::uint32_t pass, SamplerKind sampler, CancelToken cancelled,
                     const MediumStateAt& state_at) {
    const std::uint64_t key = hash_keys(seed, pass, 0x706f696e7473ull);
    surfels_ = draw_points(surfaces, settings, key, cancelled);
    hierarchy_.emplace(surfels_, HierarchySettings{.memory_budget = settings.memory_budget});
    MicroBufferSettings of_pass = buffers;
    of_pass.place = ray_place(hash_keys(seed, 0x706c616365ull), pass);
    buffers_.emplace(*hierarchy_, of_pass);
    const SurfelSides sides(surfaces, shapes, surfels_, state_at);
    std::vector<Rgb> light = arriving(scene, sides, settings, seed, pass, sampler, cancelled);
    if (scene.has_media()) {
        volume_.emplace(scene, *hierarchy_, *buffers_, of_pass, settings.volume, state_at, key, cancelled);
        light = exchanged_in_media(scene, sides, std::move(light), settings, key, cancelled);
        cost_.bytes += volume_->memory_bytes();
    } else if (settings.light == StoredLight::radiosity) {
        light = point_radiosity(*hierarchy_, *buffers_, sides, std::move(light),
                                {std::max(0, settings.bounces - 1), settings.level, key, cancelled});
    }
    const SurfelSides::Radiance sent = sides.reflected(light);
    radiance_.emplace(*hierarchy_, sent.front, sent.back);
    cost_.places = sides.size();
    cost_.bytes += hierarchy_->memory_bytes() + sides.memory_bytes() +
                   surfels_.size() * (2 * sizeof(Vec3) + sizeof(SurfacePoint) + 2 * sizeof(Rgb));
}

std::vector<Rgb> LitPoints::arriving(const LitScene& scene, const SurfelSides& sides,
                                     const LitPointSettings& settings, std::uint64_t seed, std::uint32_t pass,
                                     SamplerKind sampler, CancelToken cancelled) {
    ArrivedLight light = direct_light_at(scene, sides, settings.light_samples,
                                         hash_keys(seed, pass, 0x6c69676874ull), cancelled);
    cost_.rays.add(light.rays);
    if (settings.light == StoredLight::vpls) {
        const lights::VplSet vpls =
            lights::trace_light_paths(scene, settings.paths, seed, pass, sampler, cancelled);
        const ArrivedLight more = vpl_light_at(scene, sides, vpls, settings.bound, cancelled);
        cost_.rays.add(vpls.rays), cost_.rays.add(more.rays), cost_.tracking.add(vpls.tracking);
        cost_.light_points = vpls.lights.size();
        add(light.irradiance, more.irradiance);
    } else if (settings.light == StoredLight::photons) {
        PhotonSettings photons;
        photons.paths = settings.paths;
        PhotonSet set = trace_photons(scene, photons, seed, pass, sampler, cancelled);
        cost_.rays.add(set.rays), cost_.tracking.add(set.tracking);
        cost_.light_points = set.surface.size();
        const SurfacePhotonMap map(std::move(set.surface));
        add(light.irradiance, photon_light_at(sides, map, {settings.neighbours, 1.0f}, cancelled).irradiance);
    }
    return std::move(light.irradiance);
}

/// Direct light of the points in media, and what they and the surfaces exchange: returns the latter's.
std::vector<Rgb> LitPoints::exchanged_in_media(const LitScene& scene, const SurfelSides& sides,
                                               std::vector<Rgb> light, const LitPointSettings& settings,
                                               std::uint64_t key, CancelToken cancelled) {
    ArrivedFluence direct = direct_fluence_at(scene, volume_->points(), settings.light_samples,
                                              hash_keys(key, 0x666c75ull), cancelled);
    cost_.rays.add(direct.rays), cost_.tracking.add(direct.tracking);
    cost_.volume_points = volume_->points().size();
    FogLight all{std::move(light), std::move(direct.fluence)};
    const int bounces = settings.light == StoredLight::radiosity ? std::max(0, settings.bounces - 1) : 0;
    const FogExchange between{
        *hierarchy_,       sides, volume_->hierarchy(), volume_->points(), volume_->hemispheres(),
        volume_->spheres()};
    all = fog_radiosity(between, std::move(all), settings.volume.level,
                        {bounces, settings.level, key, cancelled});
    volume_->set_light(all.fluence);
    return std::move(all.irradiance);
}

}  // namespace mote::gathering
