#include "integrators/path_tracing/guiding_settings.h"

#include <fmt/format.h>

#include <algorithm>

namespace mote::integrators {

using namespace core;

const ParameterList<GuidingSettings>& guiding_rows() {
    using S = GuidingSettings;
    static const ParameterList<S> list{
        row("guiding", &S::mode,
            {{"off", Guiding::off},
             {"automatic", Guiding::automatic},
             {"directions", Guiding::directions},
             {"on", Guiding::on}},
            "Paths guided by light that is learned before and in the first passes: their directions, and, "
            "on, "
            "where they scatter in media and end; automatic: what trial passes find to have less noise for "
            "the same work."),
        row("guiding_passes", &S::passes, at_least(1),
            "Training passes of guided paths; all but the first seven are passes of the picture."),
        row("guiding_paths", &S::paths, at_least(16), "Paths of a training pass that are learned from."),
        row("guiding_leaf_samples", &S::leaf_samples, above(0),
            "A cell of the field is split once it has received more samples."),
        row("guiding_memory", &S::memory, above(0, "MiB"),
            "Largest size of the field; beyond it no cell is split.")};
    return list;
}

void plan_guiding(Plan& plan, const GuidingSettings& s, const Requirements& r, bool media) {
    if (s.mode == Guiding::off)
        return plan.leave_out("guiding", "directions by BSDF and phase function alone", "guiding is off");
    const bool in_media = media && r.media_scattering && s.mode != Guiding::directions;
    const bool vertices = in_media && !r.media_emissive;
    plan.run("guiding",
             fmt::format("{}; {} training passes of {} paths; all but the first {} are the picture's own",
                         vertices ? "directions, vertices in media, roulette" : "directions", s.passes,
                         s.paths, std::min(s.passes, first_training_passes)),
             s.mode == Guiding::automatic ? "as far as trial passes find less noise for the same work"
                                          : "requested");
    if (in_media && !vertices)
        plan.leave_out("guided vertices in media", "distances by extinction alone",
                       "light of media that glow is sampled at collisions");
}

}  // namespace mote::integrators
