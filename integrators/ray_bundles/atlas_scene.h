// The surfaces of a scene as all passes of `mote_ray_bundles` share them.
#pragma once

#include "core/scene/scene.h"
#include "gathering/atlas/surface_locator.h"
#include "gathering/ray_bundles/bundle_tracer.h"
#include "integrators/ray_bundles/ray_bundle_settings.h"

namespace mote::integrators {

struct AtlasScene {
    gathering::SurfaceTriangles surfaces;
    gathering::SurfaceAtlas atlas;
    gathering::TexelMaterials materials;
    gathering::SurfaceLocator locator;
    gathering::BundleTracer tracer;

    /// Throws InputError for scenes one shape of which takes all texels.
    AtlasScene(const core::Scene& scene, const RayBundleSettings& settings, const core::MemoryBudget& memory);
    AtlasScene(const AtlasScene&) = delete;  // its members refer to each other
    AtlasScene& operator=(const AtlasScene&) = delete;

    void add_statistics(core::Statistics& statistics) const;
};

}  // namespace mote::integrators
