// First hits of a batch of rays.
#pragma once

#include "core/geometry/embree_scenes.h"
#include "core/geometry/ray_batch.h"

namespace mote::core::embree {

/// `coherent`: neighbours have similar directions.
void closest(const ShapeScenes& scenes, const RayBatch& rays, bool coherent, HitBatch& hits);

/// Embree's report of a ray that met a surface.
inline RawHit raw_hit(const HitBatch& hits, int i) {
    return {hits.t[i], hits.u[i], hits.v[i], hits.geometry[i], hits.primitive[i], hits.instance[i]};
}

}  // namespace mote::core::embree
