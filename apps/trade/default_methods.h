// The methods of a trade without a methods file.
#pragma once

#include <string>

#include "core/scene/requirements.h"

namespace mote::apps::trade {

/// A methods file for a scene that requires this: a path tracer, bounded and unbounded virtual point lights,
/// compensation and photons; in homogeneous media among point-like lights also equi-angular sampling, and
/// spherical lights where there are no media. Twenty seconds for every method and each of two seeds.
std::string default_methods(const core::Requirements& requirements);

}  // namespace mote::apps::trade
