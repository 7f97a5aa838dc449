// Screen-space bias compensation at the end of a render (Engelhardt 2013, Ch. 11), for the light that
// surfaces reflect; light first scattered in media may be compensated by another method in the passes: the
// combination that Sec. 10.6 names as future work.
#include "compensation/plan_compensation.h"
#include "compensation/residual.h"
#include "core/parameters/add_type.h"
#include "core/render/cpu_clock.h"
#include "integrators/register_parts.h"
#include "integrators/screen_space_compensation/hidden_light.h"
#include "screenspace/g_buffer/g_buffer.h"

namespace mote::integrators {

using namespace core;

namespace {

enum class ScreenSpaceReceivers : std::uint8_t { surfaces };

/// The parameters of a scene file.
struct ScreenSpaceFile {
    ScreenSpaceSettings settings;
    ScreenSpaceReceivers receivers = ScreenSpaceReceivers::surfaces;
    std::shared_ptr<const compensation::Residual> media = std::make_shared<compensation::Residual>();
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

class PreparedScreenSpace final : public compensation::PreparedResidual {
  public:
    PreparedScreenSpace(const compensation::ResidualView& view, const ScreenSpaceSettings& settings,
                        const compensation::Residual& media)
        : view_{view.scene, view.options, view.bound, view.max_depth, view.layer},
          settings_(settings),
          media_(media.prepare(view)),
          hidden_(view.scene, view.options, settings, view.max_depth, view.bound) {}

    std::unique_ptr<compensation::TileResidual> for_task(const lights::VplSet& vpls,
                                                         lights::GatherScratch& scratch,
                                                         WalkContext& walk) override {
        return media_->for_task(vpls, scratch, walk);
    }
    void begin(PassImage& image) override {
        media_->begin(image);
        if (hidden_.any()) image.finish_late();
    }
    bool pass(const PassContext& context, const lights::VplSet& vpls, PassImage& image) override {
        return media_->pass(context, vpls, image) && hidden_.pass(context, vpls, hidden_layer(), image);
    }
    void finish(Film& film, CancelToken cancelled) override;
    void add_statistics(Statistics& statistics) const override {
        media_->add_statistics(statistics);
        statistics.values["ssbc_samples"] = double(samples_);
        statistics.seconds["ssbc"] = seconds_;
        statistics.values["ssbc_cpu_seconds"] = cpu_seconds_;
        hidden_.add_statistics(statistics);
    }

  private:
    std::size_t hidden_layer() const { return view_.layer + (view_.scene.has_media() ? 2 : 1); }

    compensation::ResidualView view_;
    ScreenSpaceSettings settings_;
    std::unique_ptr<compensation::PreparedResidual> media_;
    HiddenLight hidden_;
    std::uint64_t samples_ = 0;  ///< nodes of the hierarchy and pixels that were added up
    double seconds_ = 0.0;       ///< G-buffers and all steps
    double cpu_seconds_ = 0.0;   ///< the same, of all threads
};

/// Fills the layer of what the bound took from light that surfaces send to the eye, direct and indirect.
void PreparedScreenSpace::finish(Film& film, CancelToken cancelled) {
    media_->finish(film, cancelled);
    const double begin = wall_seconds(), cpu_begin = process_cpu_seconds();
    const Scene& scene = view_.scene;
    const auto buffers =
        screenspace::make_g_buffers(scene, scene.camera(), film.width(), film.height(), settings_.layers);
    std::vector<Rgb> light(film.pixels(), Rgb(0.0f));
    for (const Transport reflected : {Transport::direct, Transport::indirect}) {
        const std::vector<Rgb> part = film.mean(std::size_t(reflected));
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += part[i];
    }
    std::vector<screenspace::HiddenSide> hidden;
    for (auto& side : screenspace::hidden_sides(buffers))
        hidden.push_back({std::move(side), film.mean(hidden_layer() + hidden.size())});
    screenspace::SsbcSettings ssbc = settings_.ssbc;
    cancelled.check();
    ssbc.refinement.cancelled = cancelled;
    ssbc.bound = view_.bound;
    const screenspace::SsbcResult result =
        screenspace::compensate(screenspace::ssbc_surfaces(buffers[0]), light, hidden, ssbc);
    film.set_mean(view_.layer, result.compensation);
    samples_ = result.counts.samples, seconds_ = wall_seconds() - begin;
    cpu_seconds_ = process_cpu_seconds() - cpu_begin;
}

class ScreenSpaceCompensation final : public compensation::Residual {
  public:
    /// `media`: compensation of receivers in media alone, in the passes.
    ScreenSpaceCompensation(const ScreenSpaceSettings& settings,
                            std::shared_ptr<const compensation::Residual> media)
        : settings_(settings), media_(std::move(media)) {}

    std::unique_ptr<compensation::PreparedResidual> prepare(
        const compensation::ResidualView& view) const override {
        if (!std::isfinite(view.bound)) return Residual::prepare(view);
        return std::make_unique<PreparedScreenSpace>(view, settings_, *media_);
    }
    std::shared_ptr<const compensation::Residual> for_media() const override { return nullptr; }
    /// Those of compensation, and auxiliary ones of the light that hidden sides reflect (hidden_light.h).
    std::vector<Layer> layers(bool media) const override {
        std::vector<Layer> result = compensation_layers(media);
        for (std::size_t side = 0; side < screenspace::hidden_side_count(settings_.layers); ++side)
            result.push_back(
                {"hidden_light_" + screenspace::hidden_side_name(side),
                 "light that hidden surfaces reflect: before the layer of this number, or behind it", true});
        return result;
    }
    bool in_passes(bool surface) const override { return !surface && media_->restores(); }
    bool works_on_mean() const override { return true; }
    bool shares_vpls() const override { return media_->shares_vpls(); }
    int eye_samples() const override { return media_->eye_samples(); }
    void plan(Plan& plan, const Scene& scene, const Requirements& r, float bound) const override {
        plan.run("compensation",
                 "screen space, " + std::to_string(settings_.ssbc.steps) + " step(s), on surfaces",
                 "after the last pass, from the picture itself");
        if (settings_.layers > 1)
            plan.run("hidden surfaces", "the first " + std::to_string(settings_.layers) + " along every ray",
                     "both sides; every pass gathers their light as well");
        plan.miss("compensation", "of surfaces by what the camera does not see",
                  settings_.layers > 1 ? "surfaces outside of the picture, and behind those layers"
                                       : "hidden surfaces and those outside of the picture are not in it");
        if (r.any_glossy() || r.any_delta())
            plan.miss("compensation", "of mirrors, glass and the glossy part of surfaces",
                      "surfaces count with what they reflect evenly");
        if (r.any_media())
            plan.miss("compensation", "media between surfaces that light each other",
                      "nothing is looked up there");
        if (media_->restores())
            media_->plan(plan, scene, r, bound);
        else
            compensation::plan_expected_loss(plan, scene, 0, bound);
    }

  private:
    ScreenSpaceSettings settings_;
    std::shared_ptr<const compensation::Residual> media_;
};

}  // namespace

void register_screen_space_compensation(Registry& registry) {
    add_type(registry, Category::compensation, "screen_space",
             "Screen-space bias compensation on surfaces, at the end of a render (Engelhardt 2013, Ch. 11).",
             screen_space_rows(),
             R"(<compensation type="screen_space"><integer name="steps" value="3"/></compensation>)",
             [](ScreenSpaceFile file, const Properties& properties) {
                 file.media = file.media->for_media();
                 if (!file.media)
                     throw InputError("'media' is compensated in the passes: none, exact or approximate",
                                      properties.where_of("media"));
                 return std::make_shared<ScreenSpaceCompensation>(file.settings, file.media);
             });
}

}  // namespace mote::integrators
