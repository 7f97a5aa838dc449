#include "gathering/radiance_exchange/texel_direct_light.h"

#include <tbb/parallel_for.h>
#include "core/geometry/shadow_segment.h"

#include "core/math/sampler.h"
#include "gathering/atlas/surface_place.h"

namespace mote::gathering {

using namespace core;

namespace {

/// The irradiance at a place from one light, over the probability of the light and its point.
TexelLightSample sample_light(const LitScene& lights, SurfaceHit hit, const Vec3& outside, float u_light,
                              const Vec2& u) {
    TexelLightSample none{outside, Rgb(0.0f)};
    // Distances to lights are from here, too: a shadow ray that begins nearer would reach the light's own
    // surface.
    hit.position += depth_below(*hit.shape) * outside;
    const LightChoice choice = lights.choose_light({hit.position, outside}, u_light);
    if (!choice.emitter) return none;
    const auto light = choice.emitter->sample_direct(hit.position, u);
    if (!light || light->inside || !(glm::dot(outside, light->wi) > 0.0f)) return none;
    const Vec3 normal = glm::dot(hit.shading.n, outside) < 0.0f ? -hit.shading.n : hit.shading.n;
    const float cosine = glm::dot(normal, light->wi);
    if (!(cosine > 0.0f)) return none;
    const Vec3 origin = offset_origin(hit, light->wi);
    const Ray shadow{origin, light->wi, 0.0f, shadow_end(origin, light->distance)};
    if (!lights.visible(shadow)) return none;
    return {light->wi, light->weight * cosine / choice.probability};
}

}  // namespace

TexelDirectLight texel_direct_light(const LitScene& lights, const SurfaceAtlas& atlas,
                                    const TexelMaterials& materials, int samples, std::uint64_t key,
                                    CancelToken cancelled) {
    TexelDirectLight result;
    const auto texels = atlas.texels();
    result.samples = samples;
    result.irradiance.assign(texels.size(), Rgb(0.0f));
    result.glossy.resize(materials.glossy.size() * std::size_t(samples));
    tbb::parallel_for(std::size_t(0), texels.size(), [&](std::size_t i) {
        if (i % 64 == 0) cancelled.check();
        const auto found =
            std::lower_bound(materials.glossy.begin(), materials.glossy.end(), std::uint32_t(i));
        const bool glossy = found != materials.glossy.end() && *found == i;
        const std::size_t place = std::size_t(found - materials.glossy.begin()) * std::size_t(samples);
        for (int k = 0; k < samples; ++k) {
            Sampler sampler(SamplerKind::sobol, key, std::uint32_t(k), i);
            AtlasTexel texel = texels[i];
            const Vec2 within = sampler.next_2d() - 0.5f;
            if (texel.whole) {
                const auto [step_x, step_y] = atlas.cell_steps(texel.triangle);
                texel.barycentric += within.x * step_x + within.y * step_y;
            }
            const SurfaceHit hit = atlas.place(texel);
            const float u_light = sampler.next_1d();
            TexelLightSample light =
                sample_light(lights, hit, outward(hit, texel.side), u_light, sampler.next_2d());
            light.irradiance /= float(samples);
            result.irradiance[i] += light.irradiance;
            if (glossy) result.glossy[place + std::size_t(k)] = light;
        }
    });
    return result;
}

}  // namespace mote::gathering
