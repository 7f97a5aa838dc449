#include "integrators/register_integrators.h"

#include "compensation/residual.h"
#include "integrators/register_parts.h"
#include "lights/selection/register_selection.h"
#include "lights/visibility/visibility.h"

namespace mote::integrators {

void register_integrators(core::Registry& registry) {
    compensation::register_compensation(registry);
    register_screen_space_compensation(registry);
    lights::register_visibility(registry);
    lights::register_selection(registry);
    register_mote_layers(registry);
    register_path(registry);
    register_volpath(registry);
    register_mote_bdpt(registry);
    register_mote_upbp(registry);
    register_mote_vpl(registry);
    register_mote_vpl_ray_bundles(registry);
    register_mote_micro_rendering(registry);
    register_mote_photon_map(registry);
    register_mote_ray_bundles(registry);
    register_mote_vsl(registry);
    register_mote_ray_lights(registry);
    register_mote_single_scattering(registry);
    register_mote_epipolar(registry);
}

}  // namespace mote::integrators
