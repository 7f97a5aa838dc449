#include "integrators/path_tracing/guiding_settings.h"

#include <fmt/format.h>

#include <algorithm>

namespace mote::integrators {

using namespace core;

const ParameterList<GuidingSettings>& guiding_rows() {
    using S = GuidingSettings;
    static const ParameterList<S> list{
        row("guiding", &S::mode,
            {{"off", Guiding::off}, {"automatic", Guiding::automatic}, {"on", Guiding::on}},
            "Directions of paths also from a field of incident radiance, learned before and in the first "
            "passes; automatic: where trial passes find less noise for the same work."),
        row("guiding_passes", &S::passes, at_least(1),
            "Training passes of guided paths; all but the first seven are passes of the picture."),
        row("guiding_paths", &S::paths, at_least(16), "Paths of a training pass that are learned from."),
        row("guiding_leaf_samples", &S::leaf_samples, above(0),
            "A cell of the field is split once it has received more samples."),
        row("guiding_memory", &S::memory, above(0, "MiB"),
            "Largest size of the field; beyond it no cell is split.")};
    return list;
}

void plan_guiding(Plan& plan, const GuidingSettings& s) {
    if (s.mode == Guiding::off)
        plan.leave_out("guiding", "directions by BSDF and phase function alone", "guiding is off");
    else
        plan.run("guiding",
                 fmt::format("{0} training passes of {1} paths; all but the first {2} are the picture's own",
                             s.passes, s.paths, std::min(s.passes, first_training_passes)),
                 s.mode == Guiding::on ? "requested"
                                       : "kept where trial passes find less noise for the same work");
}

}  // namespace mote::integrators
