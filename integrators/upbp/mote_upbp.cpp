// `mote_upbp`: points, beams and paths in one estimator (Křivánek et al. 2014), in homogeneous media and
// grids.
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/register_parts.h"
#include "integrators/upbp/upbp_settings.h"

namespace mote::integrators {

using namespace core;

namespace {

class MoteUpbp final : public Integrator {
  public:
    explicit MoteUpbp(const UpbpSettings& settings) : settings_(settings) {}

    std::string type() const override { return "mote_upbp"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        return transport_layers(scene.has_media());
    }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        return make_upbp_estimator(scene, options, settings_);
    }

  private:
    UpbpSettings settings_;
};

Plan MoteUpbp::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    plan.run("paths", "one from the eye and one from a light per pixel and pass",
             "every eye path merges with the light paths of all pixels");
    if (settings_.connections)
        plan.run("connections", "as in mote_bdpt", "light that no kernel blurs");
    else
        plan.miss("connections", "none",
                  "bpt is false: light that only mirrors and glass send is hit, no other");
    if (settings_.surface) plan.run("surface photons", "kernel of two dimensions", "at eye vertices");
    if (settings_.point_point && r.media_scattering)
        plan.run("point-point 3D", "kernel of three dimensions", "at collisions of the eye path");
    const auto beams = [&](BeamLength wanted) {
        if (possible_length(scene, wanted) == BeamLength::short_beam)
            return "short: as long as the sampled distance";
        return wanted == BeamLength::long_beam
                   ? "long: up to the first surface, with a transmittance that may be an estimate"
                   : "long: short beams need media that scatter, and are grey or homogeneous";
    };
    if (settings_.point_beam && r.media_scattering)
        plan.run("point-beam 2D", "kernel of two dimensions", "photons beside query beams");
    if (settings_.beam_beam && r.media_scattering) {
        plan.run("beam-beam 1D", "kernel of one dimension", "beams of light paths that query beams cross");
        plan.run("beams of light paths", beams(settings_.light_beams), "light_beams");
    }
    if ((settings_.point_beam || settings_.beam_beam) && r.media_scattering)
        plan.run("query beams", beams(settings_.query_beams), "query_beams");
    plan.run("weights",
             settings_.heuristic == Heuristic::power ? "power heuristic, exponent 2" : "balance heuristic",
             "of all techniques that find the same path; in media by the optical depth of its edges");
    plan.run("kernels", "radii shrink from pass to pass",
             settings_.alpha < 1.0 ? "bias and noise of the mean both go to zero with the number of passes"
                                   : "alpha is 1: they do not shrink, and the bias stays");
    if (settings_.efforts_by_trial())
        plan.run("efforts", "each technique is tried as often as pays",
                 "the least variance times work, by a trial");
    plan_media(plan, r);
    if (r.lights_media > 0)
        plan.run("emission of media", "met by eye paths alone", "no light path starts in a medium");
    plan_choice_of_lights(plan, scene);
    return plan;
}

}  // namespace

void register_mote_upbp(Registry& registry) {
    using S = UpbpSettings;
    const Choices<BeamLength> lengths{{"short", BeamLength::short_beam}, {"long", BeamLength::long_beam}};
    add_type<S>(
        registry, Category::integrator, "mote_upbp",
        "Points, beams and paths in one estimator: bidirectional paths merged with photons on surfaces and "
        "in "
        "media.",
        {within(&S::limits, eye_path_rows()),
         row("bpt", &S::connections, "Connections of light paths and eye paths, as mote_bdpt has."),
         row("surf", &S::surface, "Photons on surfaces."),
         row("pp3d", &S::point_point, "Photons in media around collisions of eye paths."),
         row("pb2d", &S::point_beam, "Photons in media along rays of eye paths."),
         row("bb1d", &S::beam_beam,
             "Rays of light paths in media that rays of eye paths cross; of 500 light paths a pass, if "
             "there "
             "are more, and by a radius that shrinks with more than 100."),
         row("light_beams", &S::light_beams, lengths,
             "Rays of light paths up to the sampled distance, or up to the first surface."),
         row("query_beams", &S::query_beams, lengths, "Likewise, rays of eye paths."),
         row("radius", &S::radius, between(0, 100),
             "Radius of all kernels in the first pass, over the radius of the scene's bounds; 0: nothing is "
             "merged. Smaller with more than 10000 pixels, so that a query finds no more."),
         row("alpha", &S::alpha, above(0).up_to(1),
             "How fast kernels shrink: their size falls as passes^(alpha - 1); 1: not at all."),
         row("heuristic", &S::heuristic, {{"power", Heuristic::power}, {"balance", Heuristic::balance}},
             "Weights of the techniques that find the same path."),
         row("efforts", &S::efforts, {{"automatic", Efforts::automatic}, {"equal", Efforts::equal}},
             "How often techniques are tried: automatic: each so often that variance times work is "
             "least, by a trial; equal, or without the balance heuristic: always."),
         row("all_connections", &S::all_connections,
             "Test every connection of an eye vertex with the light path; false: one, sampled by its "
             "unoccluded contribution.")},
        R"(<integrator type="mote_upbp"><float name="radius" value="0.01"/></integrator>)",
        [](const S& s) { return std::make_shared<MoteUpbp>(s); });
}

}  // namespace mote::integrators
