// OpenEXR sorts channels by name; an attribute keeps the order that a picture had.
#pragma once

namespace mote::core {

/// Names of the channels in the picture's order, separated by blanks.
inline constexpr char channel_order[] = "channelOrder";

}  // namespace mote::core
