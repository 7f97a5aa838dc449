// Hands everything in media/ to the registry.
#pragma once

namespace mote::core {
class Registry;
}

namespace mote::media {

/// Every medium, volume and phase function.
void register_media(core::Registry& registry);

}  // namespace mote::media
