// Light of a pixel in pass 0: the vertices of its eye path, and the points that brought it light, VPLs or
// photons of the scene's method (core/render/point_lights.h).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "session/loaded_scene.h"

namespace mote::viewer {

/// Points that are listed, and shown over the image, at most.
inline constexpr std::size_t max_listed_lights = 100, max_shown_points = 2000;

/// {"first": position, depth, normals, shape of what the ray through the pixel's centre hits, or null;
///  "path": vertices of the eye path, with position, film position, throughput;
///  "kind": "VPL" or "photon"; "method": of these points; "facts": [topic, sentence], choices of the method;
///  "connected": points that were connected for the pixel; "lit_by": those with light; "sources": the
///  brightest, with index, position, film position, depth of the light path, light, weight, cluster (VPLs
///  that it represents) and unbounded light, each null where there is none; "sum", "residual": light of all,
///  and light that the bound removed}.
/// A method that has no such points is explained by `mote_vpl` with the scene's settings, else its defaults.
/// Throws InputError for a pixel outside of the image.
nlohmann::json pixel_light(const session::LoadedScene& scene, int x, int y, std::uint64_t seed);

/// {"kind", "method", "count": of all points; "points": [x, y, r, g, b] of those that the camera sees, every
///  n-th where they are many: film position, and power over the largest}.
nlohmann::json light_points(const session::LoadedScene& scene, std::uint64_t seed);

}  // namespace mote::viewer
