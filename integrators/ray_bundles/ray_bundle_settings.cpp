#include "integrators/ray_bundles/ray_bundle_settings.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "integrators/eye_path/eye_path_parameters.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Is the string `name` the second of two words? Throws InputError where it is neither.
bool second_of(const Properties& p, const std::string& name, const std::string& first,
               const std::string& second) {
    const std::string word = p.get_string(name, first);
    const std::vector<std::string> known{first, second};
    if (word != first && word != second)
        throw InputError(fmt::format("{} is '{}' or '{}', not '{}'{}", name, first, second, printable(word),
                                     suggestion(word, known)),
                         p.where_of(name));
    return word == second;
}

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
    e.batch = std::uint32_t(p.get_int_in("batch", 16, 1, 256));
    e.directions = std::uint32_t(p.get_int_in("directions", 512, 1, 1 << 24));
    if (e.directions < e.batch)
        throw InputError(fmt::format("directions must not be below batch, which is {}", e.batch),
                         p.where_of("directions"));
    e.warm_up = std::uint32_t(p.get_int_in("warm_up", 8, 0, 1 << 20));
    e.bounces = int(p.get_int_in("bounces", 8, 1, 4096));
    e.rays_per_texel = positive(p, "rays_per_texel", 1.0, false);
    e.transfer = second_of(p, "transfer", "interleaved", "one_bounce")
                     ? gathering::LightTransfer::one_bounce
                     : gathering::LightTransfer::interleaved;
    e.lights = !second_of(p, "direct", "bundles", "lights");
    e.glossy = p.get_bool("glossy_transfer", true);
    s.light_samples = int(p.get_int_in("light_samples", 4, 1, 4096));
    s.eye_samples = int(p.get_int_in("eye_samples", 4, 1, 4096));
    s.final_gathering = second_of(p, "view", "atlas", "final_gathering");
    return s;
}

std::vector<Parameter> ray_bundle_parameters() {
    return {
        {"rr_depth", "integer", "5",
         "depth from which Russian roulette may end a path at surfaces that are not diffuse"},
        hide_emitters_parameter(),
        {"directions", "integer", "512",
         "directions of a pass; one bounce at a time: of all bounces together"},
        {"batch", "integer", "16",
         "directions after which senders and receivers are exchanged; threads have a direction each"},
        {"transfer", "string", "interleaved",
         "'interleaved': what a batch received is sent by the next, all bounces at once; 'one_bounce': one "
         "bounce "
         "after the other"},
        {"bounces", "integer", "8",
         "one bounce at a time: reflections that are followed, the last towards the eye"},
        {"warm_up", "integer", "8", "interleaved: batches at the start whose indirect light is not counted"},
        {"direct", "string", "bundles",
         "light of area lights and of the environment: carried by 'bundles', or drawn by 'lights' at texels "
         "and "
         "pixels; lights with a position are drawn in either case"},
        {"light_samples", "integer", "4", "connections of a texel to lights that are drawn"},
        {"glossy_transfer", "boolean", "true",
         "surfaces that are not diffuse reflect light to others (interleaved alone); false: towards the eye "
         "alone"},
        {"view", "string", "atlas",
         "light on diffuse surfaces: that of the 'atlas', or where paths from there arrive "
         "('final_gathering')"},
        {"texels_per_metre", "float", "0", "of the atlas; 0: as many as texel_budget allows"},
        {"texel_budget", "integer", "65536",
         "texels at most, both sides of two-sided surfaces counted; a density that needs more is refused"},
        {"rays_per_texel", "float", "1", "rays of a bundle that meet a texel seen at right angles"},
        {"eye_samples", "integer", "4", "eye paths a pixel and pass"}};
}

}  // namespace mote::integrators
