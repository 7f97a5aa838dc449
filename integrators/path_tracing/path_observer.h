// Receives the vertices of a packet's paths while they are traced.
#pragma once

#include "integrators/eye_path/eye_packet.h"

namespace mote::integrators {

/// Receives nothing by itself; for derived classes.
template <bool Media>
class PathObserver {
  public:
    using Packet = EyePacket<Media>;
    using Lane = typename Packet::Lane;

    virtual ~PathObserver() = default;
    /// Before a segment of a lane makes its vertex.
    virtual void on_segment(int /*i*/, const Lane&, const EyeSegment&) {}
    /// After a segment, before its vertex is connected to lights; there is none where the lane has ended.
    virtual void on_arrival(int /*i*/, const Lane&) {}
    /// After the vertex was connected to lights.
    virtual void on_connected(int /*i*/, const Lane&) {}
};

}  // namespace mote::integrators
