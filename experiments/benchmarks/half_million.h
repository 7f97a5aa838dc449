// A room of half a million triangles, made in code: six walls of displaced grids and two bumpy balls, lit by
// a rectangle below the ceiling.
#pragma once

#include <memory>

#include "core/scene/scene.h"

namespace mote::benchmarks {

/// The room, its second ball of rough metal where `glossy`; `integrator` is the type of Scene::integrator().
std::unique_ptr<core::Scene> make_room(const std::string& integrator, int width, int height,
                                       bool glossy = true);

}  // namespace mote::benchmarks
