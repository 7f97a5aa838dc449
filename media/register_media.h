// Hands everything in media/ to the registry.
#pragma once

namespace mote::core {
class Registry;
}

namespace mote::media {

void register_media(core::Registry& registry);

}  // namespace mote::media
