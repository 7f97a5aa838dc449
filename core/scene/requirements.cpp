// Visits every shape, light and medium of a scene once.
#include "core/scene/requirements.h"

#include <algorithm>
#include <set>

#include "core/geometry/instances.h"
#include "core/geometry/triangle_mesh.h"
#include "core/scene/scene.h"

namespace mote::core {
namespace {

void count_shapes(const Scene& scene, Requirements& r) {
    for (const auto& shape : scene.shapes()) {
        ++r.shapes;
        const auto* instanced = dynamic_cast<const InstancedShape*>(shape.get());
        if (dynamic_cast<const TriangleMesh*>(instanced ? &instanced->original() : shape.get()))
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
        else if (traits.kind == EmitterKind::medium)
            ++r.lights_media;
        else
            ++r.lights_point;
    }
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
        r.media_estimators.push_back(traits.estimator);
        r.media_estimator_reasons.push_back(traits.estimator_reason);
        const Bounds3 box = scene.medium_extent(*medium);
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
