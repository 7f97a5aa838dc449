#include "integrators/path_tracing/guiding_settings.h"

#include <fmt/format.h>

namespace mote::integrators {

using namespace core;

const ParameterList<GuidingSettings>& guiding_rows() {
    using S = GuidingSettings;
    static const ParameterList<S> list{
        row("guiding", &S::mode,
            {{"off", Guiding::off}, {"automatic", Guiding::automatic}, {"on", Guiding::on}},
            "Paths guided by light that is learned between the passes; automatic: as far as trial passes "
            "find "
            "less noise for the same work."),
        row("guiding_passes", &S::passes, at_least(1),
            "Training passes of guided paths at most; then what they learned is frozen."),
        row("guiding_paths", &S::paths, at_least(16), "Paths of a training pass."),
        row("guiding_share", &S::share, above(0),
            "Counted work of training, at most, over that of the passes so far."),
        row("guiding_leaf_samples", &S::leaf_samples, above(0),
            "A cell of the field is split once it has received more samples."),
        row("guiding_memory", &S::memory, above(0, "MiB"),
            "Largest size of the field; beyond it no cell is split."),
        row("guiding_vertices", &S::vertices,
            "Guided paths scatter in media where they expect light; false: directions alone are guided.")};
    return list;
}

void plan_guiding(Plan& plan, const GuidingSettings& s, const Requirements& r, bool media) {
    const bool in_media = media && r.media_scattering;
    if (s.mode == Guiding::off)
        plan.leave_out("guiding", "directions by BSDF and phase function alone", "guiding is off");
    else
        plan.run(
            "guiding",
            fmt::format(
                "{}; up to {} training passes of {} paths between those of the picture, for {:.3g} % of its "
                "work, none of them in the picture",
                s.vertices && in_media && !r.media_emissive ? "directions, vertices in media" : "directions",
                s.passes, s.paths, 100.0 * s.share),
            s.mode == Guiding::on ? "requested" : "as far as trial passes find less noise for the same work");
    if (s.mode != Guiding::off && s.vertices && in_media && r.media_emissive)
        plan.leave_out("guided vertices in media", "distances by extinction alone",
                       "light of media that glow is sampled at collisions");
}

}  // namespace mote::integrators
