#include "integrators/path_tracing/trace_path.h"

#include "compensation/bounded_geometry.h"

namespace mote::integrators {

using namespace core;

template <bool Media>
TransportSum trace_path(const Scene& scene, const PathSettings& settings, const EyeRay& eye,
                        WalkContext& context) {
    TransportSum sum;
    EyePath<Media> path(scene, settings.limits, eye, context);
    const bool bounded = std::isfinite(settings.bound);
    const bool lit_along = Media && settings.equiangular && !settings.equiangular->empty();
    const auto light_along = [&](const EyeSegment& segment) {
        if (!lit_along || !path.wants_along() || path.depth() == settings.limits.max_depth) return;
        sum[path.layer_along()] +=
            lights::throughput_of<Media>(segment.before) *
            settings.equiangular->scattered_along(scene, segment.ray, segment.event.surface_distance,
                                                  segment.start, path.sampler().next_2d(), context);
    };
    while (path.advance(context, sum, light_along)) {
        const ScatteringVertex& vertex = path.vertex();
        const bool vpl_edge = bounded && path.scatterings() == 1;
        path.end_at_delta(vpl_edge);
        if (vpl_edge)
            // min(G*, b)/G* of the edge between the first connectable vertex and this one, where no VPL
            // stands on a delta surface: what continues from there is not part of the bounded transport.
            path.scale(
                compensation::bounded_fraction(path.first_cosine() * vertex.geometric_cosine(vertex.wo),
                                               path.segment_length(), settings.bound));
        if (vertex.connectable() && path.wants_connection())
            sum[path.layer_of_connection()] += path.sample_light(context, {lit_along});
    }
    return sum;
}

template TransportSum trace_path<true>(const Scene&, const PathSettings&, const EyeRay&, WalkContext&);
template TransportSum trace_path<false>(const Scene&, const PathSettings&, const EyeRay&, WalkContext&);

}  // namespace mote::integrators
