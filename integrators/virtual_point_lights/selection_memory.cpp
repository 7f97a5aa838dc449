#include "integrators/virtual_point_lights/selection_memory.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "lights/selection/light_hierarchy.h"
#include "lights/selection/light_tree.h"
#include "lights/selection/power_candidates.h"
#include "lights/selection/shared_columns.h"

namespace mote::integrators {

using namespace core;

std::size_t selection_bytes(const SelectionSettings& s, std::size_t lights) {
    if (s.by_matrix()) {
        const std::size_t one = s.matrix.bytes(lights, 1);
        // Lights of the pass that has the rows, and of another one that takes their clusters over.
        return s.shared_passes > 1 ? std::max(one, lights::SharedColumns::bytes(lights, s.matrix.slices))
                                   : one;
    }
    if (!s.by_hierarchy()) return 0;
    if (!s.cuts() && !s.by_power())
        return lights * (lights::LightTree::bytes_a_light + lights::LightTree::building_bytes_a_light);
    return lights * (lights::LightHierarchy::bytes_a_light + lights::LightHierarchy::building_bytes_a_light +
                     (s.by_power() ? lights::PowerCandidates::bytes_a_light : 0));
}

void check_selection_memory(const SelectionSettings& settings, std::size_t lights) {
    if (const std::size_t bytes = selection_bytes(settings, lights); bytes > settings.max_bytes)
        throw InputError(fmt::format("selecting from {} virtual point lights takes {:.4g} MB while it is "
                                     "built, and may take the {:.4g} MB of max_megabytes",
                                     lights, double(bytes) * 1e-6, double(settings.max_bytes) * 1e-6),
                         settings.where);
}

}  // namespace mote::integrators
