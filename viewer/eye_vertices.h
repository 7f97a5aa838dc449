// Through a pixel: the first hit of its ray, and the vertices of its eye path.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/render/integrator.h"
#include "core/scene/scene.h"

namespace mote::viewer {

/// [x, y, z].
nlohmann::json numbers(const core::Vec3& v);
/// Where a point is seen on the film; null outside of it.
nlohmann::json film_position(const core::Scene& scene, const core::Vec3& p);

/// Position, depth, normals and shape of what the ray through the pixel's centre hits, or null.
nlohmann::json first_hit(const core::Scene& scene, int x, int y);

/// Position, film position, kind, length of the segment and throughput of each vertex of a pixel's eye path,
/// as a path tracer continues it.
nlohmann::json eye_vertices(const core::Scene& scene, const core::RenderOptions& options,
                            const core::PassContext& pass, int x, int y);

}  // namespace mote::viewer
