#include "gathering/radiance_exchange/texel_materials.h"

#include <tbb/parallel_for.h>

#include "core/geometry/bsdf_point.h"
#include "core/scene/emitter.h"

namespace mote::gathering {

using namespace core;

namespace {

bool diffuse(const Bsdf* bsdf) { return bsdf && bsdf->traits().diffuse; }
bool directional(const Bsdf* bsdf) { return bsdf && bsdf->traits().smooth && !bsdf->traits().diffuse; }

TexelMaterial material_at(const SurfaceHit& hit, SurfaceSide side) {
    TexelMaterial m;
    const Bsdf* bsdf = hit.shape->bsdf.get();
    const float up = side == SurfaceSide::front ? 1.0f : -1.0f;
    if (diffuse(bsdf))
        m.reflectance = bsdf->diffuse_reflectance(bsdf_point(hit), {0, 0, up}).value_or(Rgb(0.0f));
    if (hit.shape->emitter) m.emission = hit.shape->emitter->radiance(hit, outward(hit, side));
    return m;
}

}  // namespace

TexelMaterials texel_materials(const SurfaceAtlas& atlas, int samples) {
    TexelMaterials result;
    const auto texels = atlas.texels();
    result.of.resize(texels.size());
    tbb::parallel_for(std::size_t(0), texels.size(), [&](std::size_t i) {
        const AtlasTexel& texel = texels[i];
        const Shape& shape = *atlas.shapes()[atlas.surfaces().shape[texel.triangle]];
        const bool textured = (shape.bsdf && shape.bsdf->traits().textured) ||
                              (shape.emitter && shape.emitter->traits().textured);
        const int n = textured ? samples : 1;
        const auto [step_x, step_y] = atlas.cell_steps(texel.triangle);
        for (int k = 0; k < n * n; ++k) {
            AtlasTexel place = texel;
            const auto at = [&](int j) { return (float(j) + 0.5f) / float(n) - 0.5f; };
            place.barycentric += at(k % n) * step_x + at(k / n) * step_y;
            const TexelMaterial m = material_at(atlas.place(place), texel.side);
            result.of[i].reflectance += m.reflectance / float(n * n);
            result.of[i].emission += m.emission / float(n * n);
        }
    });
    for (std::size_t i = 0; i < texels.size(); ++i)
        if (directional(atlas.shapes()[atlas.surfaces().shape[texels[i].triangle]]->bsdf.get()))
            result.glossy.push_back(std::uint32_t(i));
    return result;
}

}  // namespace mote::gathering
