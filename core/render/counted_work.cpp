#include "core/render/counted_work.h"

namespace mote::core {

namespace {

template <typename Counts>
double of(const Counts& counts, const char* name) {
    const auto found = counts.find(name);
    return found == counts.end() ? 0.0 : double(found->second);
}

}  // namespace

double counted_work(const Statistics& s) {
    const double rays =
        of(s.rays, "closest") + work_of_occlusion * (of(s.rays, "occlusion") + of(s.rays, "boundary"));
    const double lookups =
        of(s.lookups, "density") + 2.0 * of(s.lookups, "shadow_maps") + of(s.values, "march_steps");
    return rays + work_of_lookup * lookups;
}

}  // namespace mote::core
