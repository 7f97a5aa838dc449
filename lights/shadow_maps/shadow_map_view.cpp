#include "lights/shadow_maps/shadow_map_view.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

ShadowMapView ShadowMapView::of_point(const Vec3& position, int size) {
    return {Kind::octahedral, position, Frame(), 1.0f, size};
}

ShadowMapView ShadowMapView::of_surface(const Vec3& position, const Vec3& normal, int size) {
    return {Kind::hemispherical, position, Frame(normal), 1.0f, size};
}

ShadowMapView ShadowMapView::of_spot(const Vec3& position, const Vec3& axis, float cutoff_radians, int size) {
    return {Kind::perspective, position, Frame(axis), std::tan(std::min(cutoff_radians, 0.49f * pi)), size};
}

ShadowMapView ShadowMapView::of_parallel(const Vec3& direction, const Vec3& center, float radius, int size) {
    return {Kind::parallel, center - radius * direction, Frame(direction), radius, size};
}

Ray ShadowMapView::ray(int texel) const {
    if (kind == Kind::octahedral) return {origin, frame.to_world(OctahedralMap{size}.direction(texel))};
    if (kind == Kind::hemispherical)
        return {origin, frame.to_world(HemiOctahedralMap{size}.direction(texel))};
    const Vec2 centre(float(texel % size) + 0.5f, float(texel / size) + 0.5f);
    const Vec2 xy = half_extent * (2.0f * (centre / float(size)) - 1.0f);
    if (kind == Kind::parallel) return {origin + xy.x * frame.s + xy.y * frame.t, frame.n};
    return {origin, glm::normalize(frame.to_world(Vec3(xy, 1.0f)))};
}

int ShadowMapView::neighbour(int i, int j) const {
    if (kind == Kind::octahedral) return OctahedralMap{size}.folded(i, j);
    return std::clamp(j, 0, size - 1) * size + std::clamp(i, 0, size - 1);
}

float ShadowMapView::spacing(float distance) const {
    switch (kind) {
        case Kind::octahedral:
            return distance * std::sqrt(4.0f * pi / float(texels()));
        case Kind::hemispherical:
            return distance * std::sqrt(2.0f * pi / float(texels()));
        case Kind::perspective:
            return distance * 2.0f * half_extent / float(size);
        case Kind::parallel:
            break;
    }
    return 2.0f * half_extent / float(size);
}

}  // namespace mote::lights
