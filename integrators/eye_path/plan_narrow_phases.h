// Warning of methods that connect light and eye through phase functions too narrow to be met by chance.
#pragma once

#include "core/render/plan.h"
#include "core/scene/scene.h"

namespace mote::integrators {

/// Connections that a medium of this mean cosine needs for one that carries light: the second moment of
/// Henyey & Greenstein's function over uniform directions, 4 pi int p^2 = (1 + g^2) / (1 - g^2)^2.
double connections_per_scattering(double g);

/// Warns where a medium scatters so narrowly that few passes hold no connection within its peak: images
/// are then too dark, and their stated noise does not show it.
void plan_narrow_phases(core::Plan& plan, const core::Scene& scene);

}  // namespace mote::integrators
