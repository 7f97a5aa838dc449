// The forms in which Embree takes many occlusion rays: one by one, sixteen at once, streams.
#pragma once

#include <string>
#include <vector>

#include "experiments/benchmarks/ray_log.h"

namespace mote::benchmarks {

/// Rays to one Embree scene, arranged for every form.
class OcclusionRays {
  public:
    /// Keeps the valid lanes of the packets, in order; `packets` may be empty.
    explicit OcclusionRays(const std::vector<LoggedPacket>& packets);
    std::size_t size() const { return singles_.size(); }

    struct Form {
        std::string name;
        double (*seconds)(const OcclusionRays&);
    };
    /// All forms that this Embree offers. Each traces all rays; arranging them is not timed.
    static std::vector<Form> forms();

  private:
    static double one_by_one(const OcclusionRays&);
    template <bool coherent>
    static double packets_as_logged(const OcclusionRays&);
    template <bool coherent>
    static double full_packets(const OcclusionRays&);
    template <bool coherent>
    static double stream_of_singles(const OcclusionRays&);
    template <bool coherent>
    static double stream_of_packets(const OcclusionRays&);

    std::vector<RTCRay> singles_;
    std::vector<LoggedPacket> logged_, full_;
    RTCScene scene_ = nullptr;
};

/// Index into forms() of the fastest for these tiles, each form tried a few times.
std::size_t fastest_form(const std::vector<OcclusionRays>& tiles);

}  // namespace mote::benchmarks
