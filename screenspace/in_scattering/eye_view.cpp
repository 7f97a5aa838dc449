#include "screenspace/in_scattering/eye_view.h"

#include "core/scene/scene.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// Where a medium can be: the closed shapes it fills, or everywhere when something names it as outside.
Bounds3 extent(const Scene& scene, const Medium& medium) {
    Bounds3 box;
    bool everywhere = scene.outermost_medium() == &medium;
    for (const auto& shape : scene.shapes()) {
        everywhere |=
            shape->exterior.get() == &medium || (shape->interior.get() == &medium && !shape->closed());
        if (shape->interior.get() == &medium) box.extend(shape->bounds());
    }
    const Bounds3 own = medium.bounds();
    if (everywhere) return own;
    box.lower = glm::max(box.lower, own.lower), box.upper = glm::min(box.upper, own.upper);
    return box;
}

}  // namespace

EyeView eye_view(const Scene& scene) {
    return {scene.camera(), [&scene](const Ray& ray) { return scene.eye_medium_state(ray); }};
}

Bounds3 scattering_extent(const Scene& scene) {
    Bounds3 box;
    for (const auto& medium : scene.media())
        if (medium->traits().scattering && !medium->traits().empty) box.extend(extent(scene, *medium));
    return box;
}

}  // namespace mote::screenspace
