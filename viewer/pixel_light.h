// The light of one pixel in one pass: the vertices of its eye path, and the virtual point lights that light
// the first of them, by contribution. It is what `mote_vpl` computes there, by the same functions.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "core/formats/xml/scene_element.h"
#include "core/scene/scene.h"

namespace mote::viewer {

/// Lights that are listed at most.
inline constexpr std::size_t max_listed_lights = 100;

/// {"first": position, depth, normals, shape of what the ray through the pixel's centre hits, or null;
///  "path": vertices of the eye path of pass 0, with position, film position, throughput;
///  "paths", "lights", "bound": size of the VPL set of pass 0 and the bound of the geometry term, those of
///  the scene's `mote_vpl` or its defaults; "vpls": the brightest with index, position, film position, depth
///  of the light path, contribution, bounded and unbounded; "sum", "residual": their bounded sum, and what
///  the bound takes away}.
/// Throws InputError for a pixel outside of the image.
/// `elements`: of the scene, with its integrator.
nlohmann::json pixel_light(const core::Scene& scene, const core::Element& elements, int x, int y,
                           std::uint64_t seed);

}  // namespace mote::viewer
