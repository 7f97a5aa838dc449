#include "integrators/screen_space_compensation.h"

#include <chrono>

#include "core/scene/properties.h"
#include "core/scene/registry.h"
#include "screenspace/g_buffer.h"

namespace mote::integrators {

using namespace core;

namespace {

std::shared_ptr<Object> make(const Properties& p) {
    const std::string receivers = p.get_string("receivers", "surfaces");
    if (receivers != "surfaces")
        throw InputError("screen-space compensation knows surfaces alone, not '" + printable(receivers) +
                             "'; for media nest <compensation name=\"media\" type=\"approximate\"/>",
                         p.where_of("receivers"));
    screenspace::SsbcSettings settings;
    const auto steps = p.get_int("steps", 2);
    if (steps < 1 || steps > 100) throw InputError("steps must lie between 1 and 100", p.where_of("steps"));
    settings.steps = int(steps);
    settings.hierarchical = p.get_bool("hierarchical", true);
    settings.half_resolution = p.get_bool("half_resolution", false);
    settings.blur = float(p.get_float_in("blur", 0.0, 0.0, 100.0));
    compensation::CompensationSettings media;
    if (const auto nested = p.child<compensation::Compensation>("media")) media = nested->settings();
    media.surfaces = false;
    return std::make_shared<ScreenSpaceCompensation>(settings, media);
}

}  // namespace

ScreenSpaceCost add_screen_space_compensation(const Scene& scene, const screenspace::SsbcSettings& settings,
                                              std::span<const std::size_t> reflected, std::size_t target,
                                              Film& film) {
    const auto begin = std::chrono::steady_clock::now();
    const auto surfaces =
        screenspace::ssbc_surfaces(screenspace::make_g_buffer(scene, film.width(), film.height()));
    std::vector<Rgb> light(film.pixels(), Rgb(0.0f));
    for (const std::size_t layer : reflected) {
        const std::vector<Rgb> part = film.mean(layer);
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += part[i];
    }
    const screenspace::SsbcResult result = screenspace::compensate(surfaces, light, settings);
    film.set_mean(target, result.compensation);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    return {result.counts.samples, seconds.count()};
}

void plan_screen_space(Plan& plan, const Requirements& r, const screenspace::SsbcSettings& settings) {
    plan.run("compensation", "screen space, " + std::to_string(settings.steps) + " step(s), on surfaces",
             "after the last pass, from the picture itself");
    plan.miss("compensation", "of surfaces by what the camera does not see",
              "hidden surfaces and those outside of the picture are not in it");
    if (r.any_glossy() || r.any_delta())
        plan.miss("compensation", "of mirrors, glass and the glossy part of surfaces",
                  "surfaces count with what they reflect evenly");
    if (r.any_media())
        plan.miss("compensation", "media between surfaces that light each other",
                  "nothing is looked up there");
}

void register_screen_space_compensation(Registry& registry) {
    registry.add(
        {Category::compensation,
         "screen_space",
         "Screen-space bias compensation on surfaces, at the end of a render (Engelhardt 2013, Ch. 11).",
         {{"steps", "integer", "2", "how often the residual operator is applied"},
          {"hierarchical", "boolean", "true", "false: sum over all pixels, quadratic in their number"},
          {"half_resolution", "boolean", "false", "gather at one pixel of four, then upsample"},
          {"blur", "float", "0", "standard deviation of an edge-preserving blur of the result [pixels]"},
          {"receivers", "string", "surfaces", "nothing else: media are not in the picture's G-buffer"},
          {"media", "compensation", "none", "compensation of light first scattered in media"}},
         R"(<compensation type="screen_space"><integer name="steps" value="3"/></compensation>)"},
        make);
}

}  // namespace mote::integrators
