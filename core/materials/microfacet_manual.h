// The rows that every rough BSDF shares in its manual page.
#pragma once

#include "core/objects/registry.h"

namespace mote::core {

/// Adds distribution, alpha and, where allowed, alpha_u and alpha_v.
void append_microfacet_parameters(Manual& manual, bool anisotropic);

}  // namespace mote::core
