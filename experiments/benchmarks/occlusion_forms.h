// The forms in which Embree takes many occlusion rays: one by one, sixteen at once, streams.
#pragma once

#include <string>
#include <vector>

#include "experiments/benchmarks/ray_log.h"

namespace mote::benchmarks {

/// Rays to one Embree scene, arranged for every form.
class OcclusionRays {
  public:
    /// Keeps the occlusion rays of the log, in order.
    explicit OcclusionRays(const RayLog& log);
    std::size_t size() const { return singles_.size(); }

    struct Form {
        std::string name;
        double (*seconds)(const OcclusionRays&);
    };
    /// All forms that this Embree has. Each traces all rays; arranging them is not timed.
    static std::vector<Form> forms();

  private:
    /// Up to sixteen rays; lanes that are not valid hold an empty interval.
    struct Packet {
        RTCRay16 rays;
        alignas(64) int valid[16];
    };
    using Packets = std::vector<Packet>;

    static void append(Packets& packets, int lane, const RTCRay& ray);
    template <bool coherent, Packets OcclusionRays::*packets>
    static double in_packets(const OcclusionRays&);
    static double one_by_one(const OcclusionRays&);
    template <bool coherent>
    static double in_stream(const OcclusionRays&);

    std::vector<RTCRay> singles_;
    Packets one_target_;  ///< the neighbouring rays that end in the same point, as VPLs are gathered
    Packets full_;        ///< sixteen consecutive rays, whatever they end in
    RTCScene scene_ = nullptr;
};

/// Index into forms() of the fastest for these tiles, each form tried a few times.
std::size_t fastest_form(const std::vector<OcclusionRays>& tiles);

}  // namespace mote::benchmarks
