#include "integrators/eye_path/eye_path_parameters.h"

namespace mote::integrators {

using namespace core;

EyePathLimits read_eye_path_limits(const Properties& properties) {
    EyePathLimits limits;
    limits.max_depth = int(properties.get_int("max_depth", -1));
    if (limits.max_depth < -1 || limits.max_depth == 0)
        throw InputError("max_depth must be -1 (no limit) or at least 1", properties.where_of("max_depth"));
    limits.rr_depth = int(properties.get_int("rr_depth", 5));
    if (limits.rr_depth < 1) throw InputError("rr_depth must be at least 1", properties.where_of("rr_depth"));
    limits.hide_emitters = properties.get_bool("hide_emitters", false);
    return limits;
}

Parameter hide_emitters_parameter() {
    return {"hide_emitters", "boolean", "false",
            "the camera looks through area lights and does not see the environment; mirrors and all other "
            "surfaces do"};
}

std::vector<Parameter> eye_path_parameters() {
    return {{"max_depth", "integer", "-1",
             "longest path in edges: 1 emission only, 2 direct light, -1 no limit; a scattering in a medium "
             "counts, "
             "a null collision does not"},
            {"rr_depth", "integer", "5", "depth from which Russian roulette may end a path"},
            hide_emitters_parameter()};
}

}  // namespace mote::integrators
