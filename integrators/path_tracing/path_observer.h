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
    /// After the vertex, if there is one, was connected to lights.
    virtual void on_connected(int /*i*/, const Lane&) {}
};

}  // namespace mote::integrators
