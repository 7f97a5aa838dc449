#include "integrators/ray_bundles/ray_bundle_settings.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "integrators/eye_path/eye_path_parameters.h"

namespace mote::integrators {

using namespace core;

namespace {

float positive(const Properties& p, const std::string& name, double usual, bool or_zero) {
    const double x = p.get_float(name, usual);
    if (!(x > 0.0 || (or_zero && x == 0.0)) || !(x < 1e6))
        throw InputError(fmt::format("{} must be {} and below 1e6", name, or_zero ? "0 or more" : "above 0"),
                         p.where_of(name));
    return float(x);
}

}  // namespace

RayBundleSettings read_ray_bundle_settings(const Properties& p) {
    RayBundleSettings s;
    s.eye.rr_depth = int(p.get_int_in("rr_depth", 5, 1, 1 << 20));
    s.eye.hide_emitters = p.get_bool("hide_emitters", false);
    s.atlas.texels_per_metre = positive(p, "texels_per_metre", 0.0, true);
    s.atlas.texel_budget = std::size_t(p.get_int_in("texel_budget", 1 << 16, 1, std::int64_t(1) << 28));
    auto& e = s.exchange;
    // Fewer directions than a batch exchange nothing.
    e.directions = std::uint32_t(p.get_int_in("directions", 512, e.batch, 1 << 24));
    e.bounces = int(p.get_int_in("bounces", 8, 1, 4096));
    e.rays_per_texel = positive(p, "rays_per_texel", 1.0, false);
    e.transfer = p.get_choice("transfer", "interleaved", {"interleaved", "one_bounce"}) == "one_bounce"
                     ? gathering::LightTransfer::one_bounce
                     : gathering::LightTransfer::interleaved;
    e.lights = p.get_choice("direct", "bundles", {"bundles", "lights"}) == "bundles";
    e.glossy = p.get_bool("glossy_transfer", true);
    s.eye_samples = int(p.get_int_in("eye_samples", 4, 1, 4096));
    return s;
}

std::vector<Parameter> ray_bundle_parameters() {
    return {
        {"rr_depth", "integer", "5",
         "depth from which Russian roulette may end a path at surfaces that are not diffuse"},
        hide_emitters_parameter(),
        {"directions", "integer", "512",
         "directions of a pass, 16 or more: noise falls with the root of their number, time grows with it; "
         "one "
         "bounce at a time: of all bounces together"},
        {"transfer", "string", "interleaved",
         "'interleaved': what 16 directions received is sent by the next 16, all bounces at once; "
         "'one_bounce': one bounce after the other, with up to twice the noise"},
        {"bounces", "integer", "8",
         "one bounce at a time: reflections that are followed, the last towards the eye"},
        {"direct", "string", "bundles",
         "light of area lights and of the environment: carried by 'bundles', or sampled by 'lights' at "
         "texels "
         "and pixels, which small lights need; lights with a position are sampled in either case"},
        {"glossy_transfer", "boolean", "true",
         "surfaces that are not diffuse reflect light to others (interleaved alone); false: towards the eye "
         "alone, faster and darker"},
        {"texels_per_metre", "float", "0",
         "of the atlas: details of light smaller than a texel are blurred; 0: as many as texel_budget "
         "allows"},
        {"texel_budget", "integer", "65536",
         "texels at most, both sides of two-sided surfaces counted; a density that needs more is refused. "
         "Bias "
         "falls with their number, time grows with it"},
        {"rays_per_texel", "float", "1",
         "rays of a bundle that meet a texel seen at right angles: less noise of texels, more time"},
        {"eye_samples", "integer", "4", "eye paths a pixel and pass: smooth edges, and more time"}};
}

}  // namespace mote::integrators
