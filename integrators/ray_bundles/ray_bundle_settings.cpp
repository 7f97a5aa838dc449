#include "integrators/ray_bundles/ray_bundle_settings.h"

namespace mote::integrators {

using namespace core;

const ParameterList<RayBundleSettings>& ray_bundle_parameters() {
    using S = RayBundleSettings;
    using Atlas = gathering::AtlasSettings;
    using Exchange = gathering::ExchangeSettings;
    using gathering::LightTransfer;
    static const ParameterList<S> list{
        within(&S::eye, eye_path_rows().without({"max_depth"})),
        within(
            &S::exchange,
            // Fewer directions than a batch exchange nothing.
            row("directions", &Exchange::directions, between(Exchange().batch, 1 << 24),
                "Directions of a pass (one bounce at a time: of all bounces together): noise falls with the "
                "root of their number, time grows with it."),
            row("transfer", &Exchange::transfer,
                {{"interleaved", LightTransfer::interleaved}, {"one_bounce", LightTransfer::one_bounce}},
                "interleaved: the light that 16 directions carried is sent by the next 16, all bounces at "
                "once. one_bounce: one bounce after the other, with up to twice the noise."),
            row("bounces", &Exchange::bounces, between(1, 4096),
                "Reflections that one_bounce follows, the last towards the eye."),
            row("direct", &Exchange::lights, {{"bundles", true}, {"lights", false}},
                "Light of area lights and of the environment: carried by bundles, or sampled at texels and "
                "pixels, which small lights need. Lights with a position are sampled in either case."),
            row("glossy_transfer", &Exchange::glossy,
                "Surfaces that are not diffuse reflect light to others (interleaved alone); if false, "
                "towards the eye alone: faster and darker."),
            row("rays_per_texel", &Exchange::rays_per_texel, inside(0, 1e6),
                "Rays of a bundle that meet a texel seen at right angles: less noise of texels, more time.")),
        within(
            &S::atlas,
            row("texels_per_metre", &Atlas::texels_per_metre, between(0, 1e6, "1/m"),
                "Resolution of the atlas: details of light smaller than a texel are blurred; 0: as many as "
                "texel_budget allows."),
            row("texel_budget", &Atlas::texel_budget, between(1, 1 << 28),
                "Texels at most, both sides of two-sided surfaces counted; a resolution that needs more is "
                "refused. Bias falls with their number, time grows with it.")),
        row("eye_samples", &S::eye_samples, between(1, 4096),
            "Eye paths a pixel and pass: smooth edges, and more time.")};
    return list;
}

}  // namespace mote::integrators
