// Methods that follow a fixed number of reflections: scenes most of whose light has more are refused.
#pragma once

#include <string>

#include "core/scene/scene.h"

namespace mote::integrators {

/// Fraction of the light between surfaces that is reflected more than `reflections` times, about:
/// r^reflections, where r is what the next surface reflects, on average, of the light that leaves a surface;
/// light that meets none, glass or a mirror counts as lost.
double light_of_more_reflections(const core::Scene& scene, int reflections);

/// Throws InputError where more than half of the light would be missing; `remedy` names what renders it.
void require_reflections(const core::Scene& scene, int reflections, const std::string& integrator,
                         const std::string& remedy);

}  // namespace mote::integrators
