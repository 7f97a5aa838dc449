// Records light at the vertices of a packet's paths, as samples that a guide learns from.
//
// What a path finds after vertex k, over its weight behind that vertex, is the radiance that arrives there
// from the direction in which it went on. Light that next-event estimation could have found as well has its
// MIS weight in it: the field learns what is left to directions. What a path finds from vertex k on, over its
// weight before that vertex, is the radiance that is reflected there: places in media are chosen by it.
#pragma once

#include "integrators/path_tracing/path_observer.h"
#include "lights/guiding/learned_guide.h"

namespace mote::integrators {

template <bool Media>
class PathRecorder final : public PathObserver<Media> {
  public:
    using Packet = EyePacket<Media>;
    using Lane = typename Packet::Lane;

    void on_segment(int i, const Lane& lane, const EyeSegment& segment) override {
        const core::ScatteringVertex& left = lane.path->vertex();
        Path& path = paths_[std::size_t(i)];
        path.left_by_record = false;
        if (lane.path->depth() == 1 || !lights::LearnedGuide::guides(left) ||
            path.arriving.size() == max_records)
            return;
        const core::PathWeights& w = segment.before;
        const float inverse_distance = 1.0f / segment.event.distance;
        if (!(w.light.x > 0.0f)) return;                                              // a delta scattering
        if (!(inverse_distance >= 0.0f) || !std::isfinite(inverse_distance)) return;  // it went nowhere
        const float inverse_pdf = w.light.x / (Media ? w.unidirectional.x : 1.0f);
        lights::GuidingSample sample{left.position, segment.ray.direction, inverse_pdf, inverse_distance};
        if (const lights::VmfMixture& lobes = lane.path->guided(); !lobes.empty) {
            sample.guide = lobes.pdf_solid_angle(sample.direction) * inverse_pdf;
            sample.own = std::max(0.0f, 1.0f - lobes.probability * sample.guide) / (1.0f - lobes.probability);
            // `weight` will be the radiance over the density: this is f cos alone.
            sample.scattered = core::average(left.eval_cos(sample.direction, core::TransportMode::radiance));
        }
        path.arriving.push_back({sample, lights::throughput_of<Media>(w), path.found, left.on_surface()});
        path.left_by_record = true;
    }
    void on_arrival(int i, const Lane& lane) override {
        Path& path = paths_[std::size_t(i)];
        if (!lane.alive) return;
        if (const float length = lane.path->segment_length(); path.left_by_record && length > 0.0f)
            path.arriving.back().sample.inverse_distance =
                std::min(1.0f / length, std::numeric_limits<float>::max());
        const core::ScatteringVertex& vertex = lane.path->vertex();
        if (Media && path.reflected.size() < max_records)
            path.reflected.push_back(
                {vertex.position, lane.path->throughput(), total(lane.sum), vertex.on_surface()});
    }
    void on_connected(int i, const Lane& lane) override {
        Path& path = paths_[std::size_t(i)];
        path.found = total(lane.sum);
    }

    /// Appends the samples of the lanes' paths, which have ended, and forgets them.
    void finish(Packet& packet, lights::GuidingSamples& samples) {
        for (int i = 0; i < Packet::width; ++i) {
            Path& path = paths_[std::size_t(i)];
            const core::Rgb all = total(packet[i].sum);
            for (const Arriving& r : path.arriving) {
                lights::GuidingSample sample = r.sample;
                sample.weight *= radiance(all - r.found, r.weight);
                if (std::isfinite(sample.weight))
                    (r.on_surface ? samples.surfaces : samples.media).push_back(sample);
            }
            for (const Reflected& r : path.reflected) {
                const float reflected = radiance(all - r.found, r.weight);
                if (std::isfinite(reflected))
                    (r.on_surface ? samples.reflected_by_surfaces : samples.reflected_by_media)
                        .push_back({r.position, reflected});
            }
            path.arriving.clear(), path.reflected.clear(), path.found = core::Rgb(0.0f);
        }
    }

    static constexpr std::size_t max_records = 64;  ///< vertices of a path that are recorded
    /// Largest memory of the records of a path [bytes].
    static constexpr std::size_t max_bytes =
        max_records * (sizeof(lights::GuidingSample) + sizeof(lights::ReflectedSample));

  private:
    struct Arriving {
        lights::GuidingSample sample;  ///< its weight is 1 / pdf so far
        core::Rgb weight;              ///< of the path behind the vertex
        core::Rgb found;               ///< by the path, up to the vertex
        bool on_surface;               ///< else in a medium
    };
    struct Reflected {
        core::Vec3 position;
        core::Rgb weight;  ///< of the path before the vertex
        core::Rgb found;   ///< by the path, before the vertex
        bool on_surface;   ///< else in a medium
    };
    struct Path {
        std::vector<Arriving> arriving;
        std::vector<Reflected> reflected;
        core::Rgb found{0.0f};        ///< up to the last vertex
        bool left_by_record = false;  ///< the last segment is that of arriving.back()
    };
    static core::Rgb total(const TransportSum& sum) {
        core::Rgb all(0.0f);
        for (const core::Rgb& light : sum.light) all += light;
        return all;
    }
    /// Average over channels; those that the path does not carry bring nothing.
    static float radiance(const core::Rgb& found, const core::Rgb& weight) {
        float sum = 0.0f;
        for (int c = 0; c < 3; ++c)
            if (weight[c] > 0.0f && found[c] > 0.0f) sum += found[c] / weight[c];
        return sum / 3.0f;
    }

    std::array<Path, Packet::width> paths_;
};

}  // namespace mote::integrators
