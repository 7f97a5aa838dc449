#include "integrators/vpl_ray_bundles/vpl_bundle_pass.h"

#include "compensation/roughness_clamping.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::integrators {

using namespace core;
using gathering::Techniques;

VplBundlePass::VplBundlePass(const LitScene& lit, const VplBundleSettings& settings,
                             const gathering::ImperfectLinks* links, const RenderOptions& options,
                             const PassContext& context)
    : vpls(lights::trace_light_paths(lit, settings.light_paths(options.memory), options.seed, context.index,
                                     options.sampler, context.cancelled)),
      bundles{lit, vpls, {}, {}, settings.techniques()} {
    const float share = 1.0f / float(settings.interleaving * settings.interleaving);
    auto& samples = bundles.samples;
    samples.directions = settings.has_bundles() ? float(settings.directions) : 0.0f;
    samples.paths = float(settings.paths), samples.light_probability = share;
    const std::size_t lights = vpls.lights.size();
    bundles.bounces = settings.bounces();
    bundles.own_rays = settings.glossy == GlossyTreatment::own_rays && bundles.bounces == 0;
    if (const std::uint32_t joined = settings.joined_lights();
        settings.has_bundles() && joined > 0 && lights > 0) {
        bundles.stride = (lights + joined - 1) / joined;
        samples.joined_probability = 1.0f / float(bundles.stride);
    }
    bundles.bound = settings.bound;
    if (settings.sky) {
        bundles.sky = lit.environment();
        but_sky.emplace(lit, std::vector<const Emitter*>{bundles.sky});
    }
    bundles.links = links;
    draw_lines(settings, options, context);
    if (links) keep_links(options, context);
    samples.continued = settings.continuation_of_pass();
    rivals = gathering::rivals_of(lit, vpls, samples);
    bundles.rivals = rivals;
    // VPLs leave to bundles what these make alone.
    const bool all = settings.techniques() == Techniques::bundles;
    for (std::size_t j = 0; j < lights; ++j)
        if ((rivals[j] > 0.0f && (all || (settings.bound && vpls.lights[j].depth > 1))) ||
            bundles.bounces > 0)
            rivals[j] = gathering::certain;
    if (settings.glossy == GlossyTreatment::clamping) {
        const compensation::RoughnessClamping clamping{.enabled = true};
        compensation::clamp_roughness(vpls, clamping, share);
        vpls.peak_directions = samples.directions * gathering::uniform_line_pdf / float(clamping.neighbours);
    }
}

/// Draws the lines of each place in the blocks of n x n pixels.
void VplBundlePass::draw_lines(const VplBundleSettings& settings, const RenderOptions& options,
                               const PassContext& context) {
    const int n = settings.interleaving;
    lines.resize(std::size_t(n) * std::size_t(n));
    if (!settings.has_bundles()) return;
    // Paths that continue along other lines of the set take them for independent ones.
    const SamplerKind kind = settings.bounces() > 1 ? SamplerKind::independent : options.sampler;
    for (std::size_t place = 0; place < lines.size(); ++place)
        for (std::uint32_t m = 0; m < settings.directions; ++m)
            lines[place].push_back(gathering::bundle_direction(bundles.sky, kind, options.seed,
                                                               std::uint32_t(place),
                                                               context.index * settings.directions + m));
}

void VplBundlePass::keep_links(const RenderOptions& options, const PassContext& context) {
    const std::size_t count = lines.size() * lines[0].size();
    kept.reserve(count);
    for (auto& of_place : lines)
        for (gathering::BundleDirection& line : of_place) {
            const std::uint64_t number = hash_keys(options.seed, context.index, kept.size());
            kept.push_back(bundles.links->bundle(line.direction, number, count, context.cancelled));
            line.kept = &kept.back();
        }
}

}  // namespace mote::integrators
