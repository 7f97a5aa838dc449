#include "gathering/atlas/surface_sides.h"

#include "core/materials/bsdf.h"
#include "core/scene/emitter.h"

namespace mote::gathering {

using namespace core;

namespace {

/// No BSDF says by itself on which sides it reflects: a few pairs of directions and, for textures, a few
/// places decide.
bool reflects(const Shape& shape, float z) {
    const int places = shape.bsdf->traits().textured ? 8 : 1;
    for (int i = 0; i < places * places; ++i)
        for (const float x : {0.0f, 0.5f, -0.8f}) {
            const Vec3 wo = glm::normalize(Vec3(x, 0.1f, z)), wi = glm::normalize(Vec3(-x, -0.1f, z));
            BsdfPoint p{
                Vec2((float(i % places) + 0.5f) / float(places), (float(i / places) + 0.5f) / float(places))};
            p.uv.attributes = shape.attributes();
            p.uv.primitive =
                std::uint32_t(std::size_t(i) * shape.primitive_count() / std::size_t(places * places));
            p.uv.position = shape.bounds().center();
            if (!is_black(shape.bsdf->eval(p, wo, wi, TransportMode::radiance))) return true;
        }
    return false;
}

}  // namespace

SurfaceSides sides_of(const Shape& shape) {
    SurfaceSides sides;
    sides.front = shape.emitter != nullptr;
    if (!shape.bsdf || !shape.bsdf->traits().smooth) return sides;
    const bool front = reflects(shape, 1.0f), back = reflects(shape, -1.0f);
    // A picture that is black at all these places says nothing: both sides take part then.
    const bool unknown = shape.bsdf->traits().textured && !front && !back;
    return {sides.front || front || unknown, back || unknown};
}

}  // namespace mote::gathering
