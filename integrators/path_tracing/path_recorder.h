// Records the radiance that arrives at the vertices of a packet's paths, as samples that a guiding field
// learns from.
//
// What a path finds after vertex k, over its weight behind that vertex, is the radiance that arrives there
// from the direction in which it went on. Light that next-event estimation could have found as well has its
// MIS weight in it: the field learns what is left to directions.
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
        std::vector<Record>& records = records_[std::size_t(i)];
        if (lane.path->depth() == 1 || !lights::LearnedGuide::guides(left) || records.size() == max_records)
            return;
        const core::PathWeights& w = segment.before;
        const float inverse_distance = 1.0f / segment.event.distance;
        if (!(w.light.x > 0.0f)) return;                                              // a delta scattering
        if (!(inverse_distance >= 0.0f) || !std::isfinite(inverse_distance)) return;  // it went nowhere
        const float inverse_pdf = w.light.x / (Media ? w.unidirectional.x : 1.0f);
        records.push_back({{left.position, segment.ray.direction, inverse_pdf, inverse_distance},
                           lights::throughput_of<Media>(w),
                           found_[std::size_t(i)],
                           left.on_surface()});
    }
    void on_connected(int i, const Lane& lane) override { found_[std::size_t(i)] = total(lane.sum); }

    /// Appends the samples of the lanes' paths, which have ended, and forgets them.
    void finish(Packet& packet, std::vector<lights::GuidingSample>& surfaces,
                std::vector<lights::GuidingSample>& media) {
        for (int i = 0; i < Packet::width; ++i) {
            const core::Rgb all = total(packet[i].sum);
            for (const Record& r : records_[std::size_t(i)]) {
                lights::GuidingSample sample = r.sample;
                sample.weight *= radiance(all - r.found, r.weight);
                if (std::isfinite(sample.weight)) (r.on_surface ? surfaces : media).push_back(sample);
            }
            records_[std::size_t(i)].clear(), found_[std::size_t(i)] = core::Rgb(0.0f);
        }
    }

    static constexpr std::size_t max_records = 64;  ///< vertices of a path that are recorded

  private:
    struct Record {
        lights::GuidingSample sample;  ///< its weight is 1 / pdf so far
        core::Rgb weight;              ///< of the path behind the vertex
        core::Rgb found;               ///< by the path, up to the vertex
        bool on_surface;               ///< else in a medium
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

    std::array<std::vector<Record>, Packet::width> records_;
    std::array<core::Rgb, Packet::width> found_{};
};

}  // namespace mote::integrators
