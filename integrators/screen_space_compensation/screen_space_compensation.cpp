#include "integrators/screen_space_compensation/screen_space_compensation.h"

#include <chrono>

#include "core/parameters/add_type.h"
#include "core/render/cpu_clock.h"
#include "screenspace/g_buffer/g_buffer.h"

namespace mote::integrators {

using namespace core;

namespace {

enum class ScreenSpaceReceivers : std::uint8_t { surfaces };

/// The parameters of a scene file.
struct ScreenSpaceFile {
    ScreenSpaceSettings settings;
    ScreenSpaceReceivers receivers = ScreenSpaceReceivers::surfaces;
    compensation::CompensationSettings media;
};

const ParameterList<ScreenSpaceFile>& screen_space_rows() {
    using S = ScreenSpaceFile;
    using Ssbc = screenspace::SsbcSettings;
    static const ParameterList<S> list{
        within(
            &S::settings,
            within(
                &ScreenSpaceSettings::ssbc,
                row("steps", &Ssbc::steps, between(1, 100), "How often the residual operator is applied."),
                row("hierarchical", &Ssbc::hierarchical,
                    "false: sum over all pixels, quadratic in their number."),
                row("half_resolution", &Ssbc::half_resolution, "Gather at one pixel of four, then upsample."),
                row("blur", &Ssbc::blur, between(0, 100, "pixels"),
                    "Standard deviation of an edge-preserving blur of the result.")),
            row("layers", &ScreenSpaceSettings::layers, between(1, 16),
                "Surfaces along every ray that send light; from 2 on also hidden ones, gathered in every "
                "pass."),
            row("hidden_share", &ScreenSpaceSettings::vpl_share, between(1, 1 << 20),
                "Hidden points share out the VPLs of a pass: each meets one of so many.")),
        row("receivers", &S::receivers, {{"surfaces", ScreenSpaceReceivers::surfaces}},
            "Nothing else: media are not in the G-buffer; for them nest a compensation named media."),
        nested("media", &S::media, Category::compensation, "none",
               "Compensation of light first scattered in media.")};
    return list;
}

std::shared_ptr<Object> make(ScreenSpaceFile file) {
    file.media.surfaces = false;
    return std::make_shared<ScreenSpaceCompensation>(file.settings, file.media);
}

}  // namespace

std::vector<Layer> ScreenSpaceSettings::film_layers() const {
    std::vector<Layer> result;
    for (std::size_t side = 0; side < screenspace::hidden_side_count(layers); ++side)
        result.push_back({"hidden_light_" + screenspace::hidden_side_name(side),
                          "light that hidden surfaces reflect: before the layer of this number, or behind it",
                          true});
    return result;
}

ScreenSpaceCost add_screen_space_compensation(const Scene& scene, const ScreenSpaceSettings& settings,
                                              float bound, const ScreenSpaceLayers& layers,
                                              CancelToken cancelled, Film& film) {
    const auto begin = std::chrono::steady_clock::now();
    const double cpu_begin = process_cpu_seconds();
    const auto buffers =
        screenspace::make_g_buffers(scene, scene.camera(), film.width(), film.height(), settings.layers);
    std::vector<Rgb> light(film.pixels(), Rgb(0.0f));
    for (const std::size_t layer : layers.reflected) {
        const std::vector<Rgb> part = film.mean(layer);
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += part[i];
    }
    std::vector<screenspace::HiddenSide> hidden;
    for (auto& side : screenspace::hidden_sides(buffers))
        hidden.push_back({std::move(side), film.mean(layers.hidden + hidden.size())});
    screenspace::SsbcSettings ssbc = settings.ssbc;
    cancelled.check();
    ssbc.refinement.cancelled = cancelled;
    ssbc.bound = bound;
    const screenspace::SsbcResult result =
        screenspace::compensate(screenspace::ssbc_surfaces(buffers[0]), light, hidden, ssbc);
    film.set_mean(layers.target, result.compensation);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    return {result.counts.samples, seconds.count(), process_cpu_seconds() - cpu_begin};
}

void plan_screen_space(Plan& plan, const Requirements& r, const ScreenSpaceSettings& settings) {
    plan.run("compensation", "screen space, " + std::to_string(settings.ssbc.steps) + " step(s), on surfaces",
             "after the last pass, from the picture itself");
    if (settings.layers > 1)
        plan.run("hidden surfaces", "the first " + std::to_string(settings.layers) + " along every ray",
                 "both sides; every pass gathers their light as well");
    plan.miss("compensation", "of surfaces by what the camera does not see",
              settings.layers > 1 ? "surfaces outside of the picture, and behind those layers"
                                  : "hidden surfaces and those outside of the picture are not in it");
    if (r.any_glossy() || r.any_delta())
        plan.miss("compensation", "of mirrors, glass and the glossy part of surfaces",
                  "surfaces count with what they reflect evenly");
    if (r.any_media())
        plan.miss("compensation", "media between surfaces that light each other",
                  "nothing is looked up there");
}

void register_screen_space_compensation(Registry& registry) {
    add_type(registry, Category::compensation, "screen_space",
             "Screen-space bias compensation on surfaces, at the end of a render (Engelhardt 2013, Ch. 11).",
             screen_space_rows(),
             R"(<compensation type="screen_space"><integer name="steps" value="3"/></compensation>)", make);
}

}  // namespace mote::integrators
