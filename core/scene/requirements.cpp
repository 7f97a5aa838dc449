// Looks at every shape, light and medium of a scene once.
#include "core/scene/requirements.h"

#include <algorithm>
#include <set>

#include "core/geometry/triangle_mesh.h"
#include "core/scene/scene.h"

namespace mote::core {
namespace {

void count_shapes(const Scene& scene, Requirements& r) {
    for (const auto& shape : scene.shapes()) {
        ++r.shapes;
        if (dynamic_cast<const TriangleMesh*>(shape.get()))
            r.triangles += shape->primitive_count();
        else
            ++r.analytic_shapes;
    }
}

/// A BSDF counts once for each kind of scattering it has: plastic is glossy or delta, and diffuse.
void count_bsdfs(const Scene& scene, Requirements& r) {
    std::set<const Bsdf*> seen;
    for (const auto& shape : scene.shapes()) {
        if (!seen.insert(shape->bsdf.get()).second) continue;
        const BsdfTraits traits = shape->bsdf->traits();
        r.textures = r.textures || traits.textured;
        if (traits.null) {
            ++r.bsdfs_null;
            continue;
        }
        if (traits.delta) ++r.bsdfs_delta;
        if (traits.smooth) ++(traits.diffuse ? r.bsdfs_diffuse : r.bsdfs_glossy);
    }
}

void count_lights(const Scene& scene, Requirements& r) {
    for (const auto& emitter : scene.emitters()) {
        const EmitterTraits traits = emitter->traits();
        r.textures = r.textures || traits.textured;
        if (traits.infinite)
            ++r.lights_infinite;
        else if (traits.kind == EmitterKind::area)
            ++r.lights_area;
        else
            ++r.lights_point;
    }
}

/// Where a medium can be met: inside the shapes that hold it, or anywhere when something names it as outside.
Bounds3 extent_of(const Medium* medium, const Scene& scene) {
    Bounds3 box;
    for (const auto& shape : scene.shapes()) {
        if (shape->interior.get() == medium) box.extend(shape->closed() ? shape->bounds() : scene.bounds());
        if (shape->exterior.get() == medium) box.extend(scene.bounds());
    }
    if (scene.camera().medium.get() == medium) box.extend(scene.bounds());
    for (const auto& emitter : scene.emitters())
        if (emitter->medium == medium) box.extend(scene.bounds());
    const Bounds3 own = medium->bounds();
    box.lower = glm::max(box.lower, own.lower), box.upper = glm::min(box.upper, own.upper);
    return box;
}

void count_media(const Scene& scene, Requirements& r) {
    for (const auto& medium : scene.media()) {
        const MediumTraits traits = medium->traits();
        ++r.media;
        ++(traits.homogeneous ? r.media_homogeneous : r.media_heterogeneous);
        r.media_emissive = r.media_emissive || traits.emissive;
        r.media_anisotropic = r.media_anisotropic || !traits.isotropic;
        r.media_chromatic = r.media_chromatic || traits.chromatic;
        r.media_scattering = r.media_scattering || traits.scattering;
        r.media_descriptions.push_back(traits.description);
        const Bounds3 box = extent_of(medium.get(), scene);
        if (!box.empty()) r.media_bounds.extend(box);
    }
    r.camera_in_medium = scene.camera_medium_state().current() != nullptr;
}

}  // namespace

Requirements find_requirements(const Scene& scene) {
    Requirements r;
    r.bounds = scene.bounds();
    count_shapes(scene, r);
    count_bsdfs(scene, r);
    count_lights(scene, r);
    count_media(scene, r);
    return r;
}

}  // namespace mote::core
