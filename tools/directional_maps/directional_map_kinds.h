// Makers of the maps behind the interface, one for each file. For directional_map.cpp alone.
#pragma once

#include "tools/directional_maps/directional_map.h"

namespace mote::tools {

std::unique_ptr<DirectionalMap> make_square_octahedral_map(int size);
std::unique_ptr<DirectionalMap> make_rectangle_octahedral_map(int size);
std::unique_ptr<DirectionalMap> make_hemi_octahedral_map(int size);
std::unique_ptr<DirectionalMap> make_cube_map(int size);
std::unique_ptr<DirectionalMap> make_latitude_longitude_map(int size);
std::unique_ptr<DirectionalMap> make_sphere_map(int size);
std::unique_ptr<DirectionalMap> make_paraboloid_map(int size);

}  // namespace mote::tools
