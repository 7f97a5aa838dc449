#include "integrators/path_tracing/trace_paths.h"

#include "compensation/bounded_geometry.h"

namespace mote::integrators {

using namespace core;

template <bool Media>
void trace_paths(const Scene& scene, const PathSettings& settings, EyePacket<Media>& packet,
                 PathObserver<Media>& observer) {
    using Lane = typename EyePacket<Media>::Lane;
    const bool bounded = std::isfinite(settings.bound);
    const bool lit_along = Media && settings.equiangular && !settings.equiangular->empty();
    const auto light_along = [&](int i, Lane& lane, const EyeSegment& segment) {
        observer.on_segment(i, lane, segment);
        EyePath<Media>& path = *lane.path;
        if (!lit_along || !path.wants_along() || path.depth() == settings.limits.max_depth) return;
        lane.sum[path.layer_along()] +=
            lights::throughput_of<Media>(segment.before) *
            settings.equiangular->scattered_along(scene, segment.ray, segment.event.surface_distance,
                                                  segment.start, path.sampler().next_2d(), packet.walk());
    };
    // min(G*, b)/G* of the edge between the first connectable vertex and this one, where no VPL stands on a
    // delta surface: what continues from there is not part of the bounded transport.
    const auto bound_edge = [&](int, Lane& lane) {
        if (!lane.alive) return;
        EyePath<Media>& path = *lane.path;
        const bool vpl_edge = path.scatterings() == 1;
        path.end_at_delta(vpl_edge);
        if (!vpl_edge) return;
        const float cosines = path.first_cosine() * path.vertex().geometric_cosine(path.vertex().wo);
        path.scale(compensation::bounded_factor(cosines, path.segment_length(), settings.bound));
    };
    const auto step = [&] {
        if (bounded) packet.for_each(bound_edge);
        packet.for_each([&](int i, const Lane& lane) { observer.on_arrival(i, lane); });
        packet.sample_lights({lit_along});
        packet.for_each([&](int i, const Lane& lane) { observer.on_connected(i, lane); });
    };
    packet.run(step, light_along);
}

template void trace_paths<true>(const Scene&, const PathSettings&, EyePacket<true>&, PathObserver<true>&);
template void trace_paths<false>(const Scene&, const PathSettings&, EyePacket<false>&, PathObserver<false>&);

}  // namespace mote::integrators
