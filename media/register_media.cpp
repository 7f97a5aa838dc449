// Registers all types of media/ by name.
#include "media/register_media.h"

#include "media/constant_volume.h"
#include "media/grid_volume.h"
#include "media/heterogeneous_medium.h"
#include "media/homogeneous_medium.h"
#include "media/phase_functions.h"
#include "media/vdb_volume.h"
#include "media/volume_texture.h"

namespace mote::media {

void register_media(core::Registry& registry) {
    register_isotropic_phase(registry);
    register_hg_phase(registry);
    register_volume_texture(registry);
    register_constant_volume(registry);
    register_grid_volume(registry);
    register_vdb_volume(registry);
    register_homogeneous_medium(registry);
    register_heterogeneous_medium(registry);
}

}  // namespace mote::media
