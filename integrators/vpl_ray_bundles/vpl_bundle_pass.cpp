#include "integrators/vpl_ray_bundles/vpl_bundle_pass.h"

#include "lights/virtual_lights/particle_tracer.h"

namespace mote::integrators {

using namespace core;
using gathering::Techniques;

VplBundlePass::VplBundlePass(const LitScene& lit, const VplBundleSettings& settings,
                             const RenderOptions& options, const PassContext& context)
    : vpls(lights::trace_light_paths(lit, settings.light_paths(), options.seed, context.index,
                                     options.sampler, context.cancelled)),
      bundles{lit, vpls, {}, {}, settings.techniques} {
    const float share = 1.0f / float(settings.interleaving * settings.interleaving);
    auto& samples = bundles.samples;
    samples.directions = settings.has_bundles() ? float(settings.directions) : 0.0f;
    samples.paths = float(settings.paths), samples.light_share = share;
    const std::size_t lights = vpls.lights.size();
    bundles.own_rays = settings.own_rays && settings.bounces == 0;
    bundles.two_way = settings.two_way, bundles.bounces = settings.bounces,
    bundles.repeats = settings.repeats;
    if (settings.has_bundles() && settings.joined > 0 && settings.bounces == 0 && lights > 0) {
        bundles.stride = (lights + settings.joined - 1) / settings.joined;
        samples.joined_share = 1.0f / float(bundles.stride);
    }
    bundles.bound = settings.bound;
    if (settings.sky) {
        bundles.sky = lit.environment();
        but_sky.emplace(lit, std::vector<const Emitter*>{bundles.sky});
    }
    samples.continued = settings.continuation_of_pass();
    rivals = gathering::rivals_of(lit, vpls, samples);
    bundles.rivals = rivals;
    // What bundles make alone, VPLs leave to them.
    const bool all = settings.techniques == Techniques::bundles;
    for (std::size_t j = 0; j < lights; ++j)
        if ((rivals[j] > 0.0f && (all || (settings.bound && vpls.lights[j].depth > 1))) ||
            settings.bounces > 0)
            rivals[j] = gathering::certain;
    if (settings.clamping.enabled) {
        compensation::clamp_roughness(vpls, settings.clamping, share);
        vpls.peak_directions =
            samples.directions * gathering::uniform_line_pdf / float(settings.clamping.neighbours);
    }
}

}  // namespace mote::integrators
