// <texture type="volume">: surfaces with the values of a volume, looked up by position.
#pragma once

namespace mote::core {
class Registry;
}

namespace mote::media {

void register_volume_texture(core::Registry& registry);

}  // namespace mote::media
