// <phase type="isotropic">: the same value in every direction.
#include "core/math/warp.h"
#include "core/parameters/add_type.h"
#include "media/phase_functions.h"

namespace mote::media {

core::PhaseSample IsotropicPhase::sample(const core::Vec3&, const core::Vec2& u) const {
    return {core::square_to_sphere(u), core::Rgb(1.0f), core::inv_four_pi};
}

void register_isotropic_phase(core::Registry& registry) {
    core::add_type(registry, core::Category::phase, "isotropic", "Scatters equally into all directions.",
                   R"(<phase type="isotropic"/>)", [] { return std::make_shared<IsotropicPhase>(); });
}

}  // namespace mote::media
