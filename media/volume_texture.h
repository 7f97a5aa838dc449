// <texture type="volume">: a volume as a texture. Textures are asked by their place on the surface, not in
// space, so only a volume that is the same everywhere can be one.
#pragma once

namespace mote::core {
class Registry;
}

namespace mote::media {

void register_volume_texture(core::Registry& registry);

}  // namespace mote::media
