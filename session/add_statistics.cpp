#include "session/add_statistics.h"

#include <algorithm>
#include <set>
#include <string>

namespace mote::session {

namespace {

/// True for values that are counts or times and grow with every pass.
bool adds_up(const std::string& name) {
    static const std::set<std::string> fixed = {
        "bound", "texels", "texels_per_metre", "charts", "points", "sphere_radius_mean", "shadow_maps"};
    return !fixed.contains(name) && !name.ends_with("_bytes") && !name.ends_with("_peak");
}

}  // namespace

void add_statistics(core::Statistics& sum, const core::Statistics& more) {
    for (const auto& [name, count] : more.rays) sum.rays[name] += count;
    for (const auto& [name, count] : more.lookups) sum.lookups[name] += count;
    for (const auto& [name, seconds] : more.seconds) sum.seconds[name] += seconds;
    for (const auto& [name, value] : more.values) {
        if (name == "noise" || name == "varianceGain") continue;  // of the sum: from its film
        if (adds_up(name))
            sum.values[name] += value;
        else  // settings are the same everywhere; of what memory takes, the most
            sum.values[name] = std::max(sum.values.contains(name) ? sum.values[name] : value, value);
    }
    for (const std::string& warning : more.warnings)
        if (std::ranges::find(sum.warnings, warning) == sum.warnings.end()) sum.warnings.push_back(warning);
    sum.non_finite_samples += more.non_finite_samples;
    sum.clamped_samples += more.clamped_samples;
}

}  // namespace mote::session
