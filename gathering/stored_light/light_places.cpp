#include "gathering/stored_light/light_places.h"

#include "core/materials/bsdfs.h"
#include "core/materials/textures.h"
#include "gathering/atlas/surface_place.h"

namespace mote::gathering {

using namespace core;

namespace {

const Bsdf& white() {
    static const std::shared_ptr<const Bsdf> bsdf = make_diffuse(make_constant_texture(Rgb(1.0f)));
    return *bsdf;
}

}  // namespace

ScatteringVertex white_vertex(const SurfaceHit& hit, bool front) {
    ScatteringVertex v;
    v.hit = hit;
    if (!front) {
        // Turned over, so that the vertex lies on the front of its surface.
        v.hit.geometric_normal = -hit.geometric_normal;
        v.hit.shading = Frame(-hit.shading.n);
    }
    v.hit.position += depth_below(*hit.shape) * v.hit.geometric_normal;
    v.position = v.hit.position, v.wo = v.hit.geometric_normal;
    v.bsdf = &white();
    return v;
}

}  // namespace mote::gathering
