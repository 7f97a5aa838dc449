#include "trade/methods_file.h"

#include <nlohmann/json.hpp>

namespace mote::trade {

std::string default_methods(const core::Requirements& requirements) {
    using nlohmann::json;
    json methods = json::array();
    const auto add = [&](const char* name, const char* integrator, const json& settings) {
        methods.push_back({{"name", name}, {"integrator", integrator}, {"settings", settings}});
    };
    const bool media = requirements.any_media();
    add(media ? "volpath" : "path", media ? "volpath" : "path", json::object());
    add("layers", "mote_layers", json::object());
    if (media && requirements.media_heterogeneous == 0 && requirements.lights_point > 0)
        add("volpath, equi-angular", "volpath", {{"equiangular", true}});
    add("VPL bounded", "mote_vpl", {{"paths", 64}});
    if (media)
        add("VPL, 2 steps of ABC", "mote_vpl",
            {{"paths", 64}, {"compensation", {{"type", "approximate"}, {"depth", 2}}}});
    add("VPL, exact compensation", "mote_vpl", {{"paths", 64}, {"compensation", "exact"}});
    add("VPL unbounded", "mote_vpl", {{"paths", 64}, {"bound", -1}});
    if (media) add("ray lights", "mote_ray_lights", json::object());
    if (!media) add("spherical lights", "mote_vsl", {{"paths", 64}});
    add("photon map", "mote_photon_map", {{"photon_paths", 20000}});
    return json({{"time", 20}, {"seeds", 2}, {"methods", methods}}).dump(2);
}

}  // namespace mote::trade
