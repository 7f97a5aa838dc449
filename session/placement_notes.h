// Media that are probably misplaced: warnings before a render.
#pragma once

#include <string>
#include <vector>

namespace mote::core {
class Scene;
}

namespace mote::session {

/// A line for every grid whose box and whose shapes overlap in less than half of the smaller of the two, with
/// the fraction; one where the scene lies so far from the origin that coordinates are coarse; and one where
/// the camera stands in a medium that its sensor does not name: Mitsuba would see none there.
std::vector<std::string> placement_notes(const core::Scene& scene);

}  // namespace mote::session
