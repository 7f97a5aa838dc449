#include "integrators/path_tracing/trace_paths.h"

#include "compensation/bounded_geometry.h"
#include "integrators/path_tracing/path_recorder.h"

namespace mote::integrators {

using namespace core;

template <bool Media>
void trace_paths(const Scene& scene, const PathSettings& settings, EyePacket<Media>& packet,
                 PathRecorder<Media>* recorder) {
    using Lane = typename EyePacket<Media>::Lane;
    const bool weighted = std::isfinite(settings.bound) || settings.taken;
    const bool lit_along = Media && settings.equiangular && !settings.equiangular->empty();
    const auto light_along = [&](int i, Lane& lane, const EyeSegment& segment) {
        if (recorder) recorder->on_segment(i, lane, segment);
        EyePath<Media>& path = *lane.path;
        if (!lit_along || !path.wants_along() || path.depth() == settings.limits.max_depth) return;
        lane.sum[path.layer_along()] +=
            lights::throughput_of<Media>(segment.before) *
            settings.equiangular->scattered_along(
                scene, {segment.ray, segment.event.surface_distance, segment.start, path.pdf_of_direction()},
                path.sampler().next_2d(), packet.walk());
    };
    const auto light_around_lamps = [&](int, Lane& lane) {
        if (!lane.alive) return;
        EyePath<Media>& path = *lane.path;
        if (!path.vertex().connectable() || !path.wants_twice() ||
            path.depth() + 1 == settings.limits.max_depth)
            return;
        lane.sum[path.layer_twice()] +=
            path.throughput() * settings.equiangular->scattered_around_lamps(
                                    scene, path.vertex(), path.state(),
                                    [&](const Vec3& wi) { return path.scattered_from(wi); }, packet.walk());
    };
    // min(G*, b)/G* of the edge between the first connectable vertex and this one, where no VPL stands on a
    // delta surface: what continues from there is not part of the bounded transport, but of what it lacks.
    const auto factors_of_edge = [&](int, Lane& lane) {
        if (!lane.alive) return;
        EyePath<Media>& path = *lane.path;
        if (path.scatterings() != 1) {
            path.set_factors({});
            return;
        }
        const float cosines = path.first_cosine() * path.vertex().geometric_cosine(path.vertex().wo);
        const float left = compensation::bounded_factor(cosines, path.segment_length(), settings.bound);
        path.set_factors(settings.taken ? LobeFactors{1.0f - left, 1.0f} : LobeFactors{left, 0.0f});
    };
    const auto step = [&] {
        if (weighted) packet.for_each(factors_of_edge);
        if (recorder) packet.for_each([&](int i, Lane& lane) { recorder->on_arrival(i, lane); });
        packet.sample_lights({lit_along});
        if (lit_along) packet.for_each(light_around_lamps);
        if (recorder) packet.for_each([&](int i, Lane& lane) { recorder->on_vertex(i, lane); });
    };
    packet.run(step, light_along);
}

template void trace_paths<true>(const Scene&, const PathSettings&, EyePacket<true>&, PathRecorder<true>*);
template void trace_paths<false>(const Scene&, const PathSettings&, EyePacket<false>&, PathRecorder<false>*);

}  // namespace mote::integrators
