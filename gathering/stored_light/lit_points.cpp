#include "gathering/stored_light/lit_points.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/math/random.h"
#include "gathering/photon_maps/photon_tracer.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Lights and directions sampled for every place. Their noise is averaged by all texels that see the place.
constexpr int light_samples = 4;
/// One place of 2^level gathers for those around it that face its way: a step of the radiosity then costs a
/// small part of what the eye's receivers gather, and three bounces keep the mean of path within 0.1 %
/// (docs/gallery/engelhardt_08_06_multibounce.md).
constexpr std::uint32_t radiosity_level = 6;
/// Photons of an estimate, as in the first pass of mote_photon_map.
constexpr DensityEstimate photon_estimate{50, 1.0f};

SurfelSettings surfel_settings(const LitPointSettings& settings) {
    SurfelSettings s;
    s.memory_budget = settings.memory_budget;
    return s;
}

/// Place of the rays in their texels: another one every pass, which together are even (Roberts' sequence:
/// multiples of the powers of one over the plastic number).
Vec2 ray_place(std::uint64_t key, std::uint32_t pass) {
    Rng rng(key);
    const double x = double(rng.next_float()) + 0.7548776662466927 * pass,
                 y = double(rng.next_float()) + 0.5698402909980532 * pass;
    return glm::min(Vec2(float(x - std::floor(x)), float(y - std::floor(y))), Vec2(one_minus_epsilon));
}

/// Throws InputError, with the file and line of the light that is strongest there, where a point's light
/// exceeds single precision: a lamp touches a surface, or lights are that strong.
void check_finite(const LitScene& scene, const SurfelSides& sides, std::span<const Rgb> light) {
    const auto bad = std::ranges::find_if(light, [](const Rgb& e) { return !is_finite(e); });
    if (bad == light.end()) return;
    const Vec3 p = sides.vertex(std::size_t(bad - light.begin())).position;
    const Emitter* strongest = nullptr;
    double most = -1.0;
    for (const auto& emitter : scene.emitters()) {
        const auto sample = emitter->sample_direct(p, Vec2(0.5f));
        const double here = sample ? double(max_component(sample->weight)) : 0.0;
        if (here > most || std::isnan(here))
            most = std::isnan(here) ? infinity : here, strongest = emitter.get();
    }
    throw InputError(
        fmt::format("the light that arrives at the surface point ({:.4g}, {:.4g}, {:.4g}) is not finite "
                    "in single precision, that of this light above all: make lights weaker, or move "
                    "it away from the surface",
                    p.x, p.y, p.z),
        strongest ? strongest->where : SourceLocation{});
}

void add(std::vector<Rgb>& sum, const std::vector<Rgb>& more) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}

}  // namespace

void LitPoints::check_memory(const LitPointSettings& settings) {
    check_surfel_memory(settings.points, surfel_settings(settings));
    PointHierarchy::check_memory(settings.points, settings.memory_budget);
}

LitPoints::LitPoints(const LitScene& scene, const SurfaceTriangles& surfaces, ShapeSpan shapes,
                     const LitPointSettings& settings, const MicroBufferSettings& buffers, std::uint64_t seed,
                     std::uint32_t pass, SamplerKind sampler, CancelToken cancelled) {
    const std::uint64_t key = hash_keys(seed, pass, 0x706f696e7473ull);
    SurfelSettings surfels = surfel_settings(settings);
    surfels.seed = key, surfels.cancelled = cancelled;
    surfels_ = blue_noise_surfels(surfaces, settings.points, surfels);
    hierarchy_.emplace(surfels_, settings.memory_budget);
    MicroBufferSettings of_pass = buffers;
    of_pass.place = ray_place(hash_keys(seed, 0x706c616365ull), pass);
    buffers_.emplace(*hierarchy_, of_pass);
    const SurfelSides sides(surfaces, shapes, surfels_);
    std::vector<Rgb> light = arriving(scene, sides, settings, seed, pass, sampler, cancelled);
    check_finite(scene, sides, light);
    if (settings.light == StoredLight::radiosity)
        light = point_radiosity(*hierarchy_, *buffers_, sides, std::move(light),
                                {std::max(0, settings.bounces - 1), radiosity_level, key, cancelled});
    const SurfelSides::Radiance sent = sides.reflected(light);
    radiance_.emplace(*hierarchy_, sent.front, sent.back);
    cost_.places = sides.size();
    cost_.bytes += hierarchy_->memory_bytes() + sides.memory_bytes() +
                   surfels_.size() * (2 * sizeof(Vec3) + sizeof(SurfacePoint) + 2 * sizeof(Rgb));
}

std::vector<Rgb> LitPoints::arriving(const LitScene& scene, const SurfelSides& sides,
                                     const LitPointSettings& settings, std::uint64_t seed, std::uint32_t pass,
                                     SamplerKind sampler, CancelToken cancelled) {
    ArrivedLight light =
        direct_light_at(scene, sides, light_samples, hash_keys(seed, pass, 0x6c69676874ull), cancelled);
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
        add(light.irradiance, photon_light_at(sides, map, photon_estimate, cancelled).irradiance);
    }
    return std::move(light.irradiance);
}

}  // namespace mote::gathering
