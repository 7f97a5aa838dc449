// Records light at the vertices of a packet's paths, as samples that a guide learns from.
//
// What a path finds after vertex k, over its weight behind that vertex, is the radiance that arrives there
// from the direction in which it went on. Light that next-event estimation could have found as well has its
// MIS weight in it: the field learns what is left to directions. In scenes with media, what a path finds from
// vertex k on, over its weight before that vertex, is the radiance that is reflected there.
#pragma once

#include "integrators/eye_path/eye_packet.h"
#include "lights/guiding/learned_guide.h"

namespace mote::integrators {

template <bool Media>
class PathRecorder {
  public:
    using Packet = EyePacket<Media>;
    using Lane = typename Packet::Lane;

    /// `largest`: all that the guide will ever decide; what vertices reflect is recorded where it chooses
    /// them.
    explicit PathRecorder(lights::GuideParts largest)
        : chooses_(Media && largest == lights::GuideParts::directions_and_vertices) {}

    /// Before a segment of a lane makes its vertex.
    void on_segment(int i, const Lane& lane, const EyeSegment& segment) {
        const core::ScatteringVertex& left = lane.path->vertex();
        Path& path = paths_[std::size_t(i)];
        path.left_by_record = false;
        if (lane.path->depth() == 1 || !lights::LearnedGuide::guides(left) ||
            path.arriving.size() == max_records)
            return;
        const float pdf = lane.path->pdf_of_direction();
        const float inverse_distance = 1.0f / segment.event.distance;
        if (std::isinf(pdf)) return;                                                  // a delta scattering
        if (!(inverse_distance >= 0.0f) || !std::isfinite(inverse_distance)) return;  // it went nowhere
        path.arriving.push_back({{left.position, segment.ray.direction, 1.0f / pdf, inverse_distance},
                                 lights::throughput_of<Media>(segment.before),
                                 path.found,
                                 left.on_surface()});
        path.left_by_record = true;
    }
    /// After a segment of a lane, before its vertex, if any, is connected to lights.
    void on_arrival(int i, const Lane& lane) {
        Path& path = paths_[std::size_t(i)];
        path.at_record = chooses_ && lane.alive && path.reflected.size() < max_records;
        if (!path.at_record) return;
        // A guide may have chosen a vertex before the end of the segment.
        const float inverse_distance = 1.0f / lane.path->segment_length();
        if (path.left_by_record && inverse_distance > 0.0f && std::isfinite(inverse_distance))
            path.arriving.back().sample.inverse_distance = inverse_distance;
        const core::ScatteringVertex& vertex = lane.path->vertex();
        path.reflected.push_back({vertex.position, lane.path->throughput(), total(lane.sum), core::Rgb(0.0f),
                                  vertex.on_surface()});
    }
    /// After the vertex of a lane was connected to lights.
    void on_vertex(int i, const Lane& lane) {
        Path& path = paths_[std::size_t(i)];
        path.found = total(lane.sum);
        if (path.at_record) path.reflected.back().found_connected = path.found;
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
                const float whole = radiance(all - r.found, r.weight),
                            indirect = radiance(all - r.found_connected, r.weight);
                if (std::isfinite(whole) && std::isfinite(indirect))
                    (r.on_surface ? samples.reflected_by_surfaces : samples.reflected_by_media)
                        .push_back({r.position, whole, indirect});
            }
            path.arriving.clear(), path.reflected.clear(), path.found = core::Rgb(0.0f);
        }
    }

    static constexpr std::size_t max_records = 64;  ///< vertices of a path that are recorded
    /// Largest memory of the samples of a path [B].
    static constexpr std::size_t max_bytes =
        max_records * (sizeof(lights::GuidingSample) + Media * sizeof(lights::ReflectedSample));

  private:
    struct Arriving {
        lights::GuidingSample sample;  ///< its weight is 1 / pdf so far
        core::Rgb weight;              ///< of the path behind the vertex
        core::Rgb found;               ///< by the path, up to the vertex
        bool on_surface;               ///< else in a medium
    };
    struct Reflected {
        core::Vec3 position;
        core::Rgb weight;           ///< of the path before the vertex
        core::Rgb found;            ///< by the path, before the vertex
        core::Rgb found_connected;  ///< and by next-event estimation there
        bool on_surface;            ///< else in a medium
    };
    struct Path {
        std::vector<Arriving> arriving;
        std::vector<Reflected> reflected;
        core::Rgb found{0.0f};        ///< up to the last vertex
        bool left_by_record = false;  ///< the last segment is that of arriving.back()
        bool at_record = false;       ///< the last vertex is that of reflected.back()
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

    bool chooses_;
    std::array<Path, Packet::width> paths_;
};

}  // namespace mote::integrators
