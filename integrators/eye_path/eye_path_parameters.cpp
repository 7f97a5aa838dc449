#include "integrators/eye_path/eye_path_parameters.h"

namespace mote::integrators {

using namespace core;

const ParameterList<EyePathLimits>& eye_path_rows() {
    static const ParameterList<EyePathLimits> list{
        row("max_depth", &EyePathLimits::max_depth, at_least(1).or_else(-1, "no limit"),
            "Longest path in edges: 1 is emission only, 2 direct light. A scattering in a medium counts, a "
            "null collision does not."),
        row("rr_depth", &EyePathLimits::rr_depth, at_least(1),
            "Depth from which Russian roulette may end a path."),
        row("hide_emitters", &EyePathLimits::hide_emitters,
            "The camera looks through area lights and does not see the environment; mirrors and all other "
            "surfaces do.")};
    return list;
}

}  // namespace mote::integrators
