#include "integrators/bidirectional/merge_kernels.h"

#include <numbers>

namespace mote::integrators {

double merge_kernel(Merge technique, const MergeVertex& v, const MergeSettings& settings) {
    constexpr double pi = std::numbers::pi;
    const auto t = std::size_t(technique);
    const double r = settings.radius[t];
    const double n = settings.light_subpaths[t] * settings.effort[t];
    if (!v.connectable || v.on_surface != (technique == Merge::surface) || !(r > 0.0)) return 0.0;
    if (!v.on_surface && !(v.sigma_t > 0.0)) return 0.0;
    switch (technique) {
        case Merge::surface:
            return n * pi * r * r;
        case Merge::point_point_3d:
            return n * (4.0 / 3.0) * pi * r * r * r * v.sigma_t;
        case Merge::point_beam_2d:
            return n * pi * r * r * spared_density(settings.eye_beams, v.tau_eye);
        case Merge::beam_beam_1d:
            return n * 2.0 * r * v.sine / v.sigma_t * spared_density(settings.light_beams, v.tau_light) *
                   spared_density(settings.eye_beams, v.tau_eye);
    }
    return 0.0;
}

double merge_terms(const MergeVertex& vertex, const MergeSettings& settings, Heuristic heuristic) {
    double sum = 0.0;
    for (std::size_t i = 0; i < merge_count; ++i)
        sum += mis_term(heuristic, merge_kernel(Merge(i), vertex, settings));
    return sum;
}

}  // namespace mote::integrators
