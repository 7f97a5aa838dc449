#include "integrators/ray_bundles/atlas_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/objects/error.h"

namespace mote::integrators {

using namespace core;

namespace {

/// An exchange keeps, besides texels, received light of every direction of a batch.
gathering::AtlasSettings atlas_settings(const RayBundleSettings& settings, const MemoryBudget& memory) {
    gathering::AtlasSettings atlas = settings.atlas;
    atlas.memory = memory;
    atlas.bytes_per_texel =
        std::size_t(settings.exchange.batch) * sizeof(gathering::Rgb4) * (settings.exchange.lights ? 2 : 1);
    return atlas;
}

/// Refuses scenes one shape of which takes all texels: rays of a bundle are a texel apart, and miss what is
/// smaller.
void require_resolved(const gathering::SurfaceAtlas& atlas) {
    constexpr double min_texels = 1e-3;  ///< of all other shapes together
    std::map<std::uint32_t, double> areas;
    for (const gathering::AtlasTexel& texel : atlas.texels())
        areas[atlas.surfaces().shape[texel.triangle]] += double(texel.area);
    double largest = 0.0;
    for (const auto& [shape, area] : areas) largest = std::max(largest, area);
    double others = 0.0;
    for (const auto& [shape, area] : areas) others += area < largest ? area : 0.0;
    const double edge = 1.0 / double(atlas.texels_per_metre());
    if (others > 0.0 && others < min_texels * edge * edge)
        throw InputError(
            fmt::format("mote_ray_bundles: a shape of {:.2g} m^2 takes all texels, which are {:.2g} m wide; "
                        "the others, {:.2g} "
                        "m^2 together, would be missed by all rays: leave it out, or use another integrator",
                        largest, edge, others));
}

}  // namespace

AtlasScene::AtlasScene(const Scene& scene, const RayBundleSettings& settings, const MemoryBudget& memory)
    : surfaces(gathering::surface_triangles(scene.shapes(),
                                            {.memory_budget = memory.at_most(std::size_t(4) << 30)})),
      atlas(surfaces, scene.shapes(), atlas_settings(settings, memory)),
      materials(gathering::texel_materials(atlas)),
      locator(surfaces),
      tracer(surfaces) {
    require_resolved(atlas);
}

void AtlasScene::add_statistics(Statistics& statistics) const {
    statistics.values["texels"] = double(atlas.size());
    statistics.values["texels_per_metre"] = double(atlas.texels_per_metre());
    statistics.values["charts"] = double(atlas.charts());
    statistics.values["atlas_bytes"] = double(atlas.memory_bytes());
}

}  // namespace mote::integrators
