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
    return ray_at(Vec2(float(texel % size) + 0.5f, float(texel / size) + 0.5f) / float(size));
}

Ray ShadowMapView::ray_at(const Vec2& position) const {
    const Vec2 p = 2.0f * position - 1.0f;
    switch (kind) {
        case Kind::octahedral:
            return {origin, frame.to_world(octahedral_unproject(p))};
        case Kind::hemispherical:
            return {origin, frame.to_world(hemi_octahedral_unproject(p))};
        case Kind::perspective:
            return {origin, glm::normalize(frame.to_world(Vec3(half_extent * p, 1.0f)))};
        case Kind::parallel:
            break;
    }
    const Vec2 xy = half_extent * p;
    return {origin + xy.x * frame.s + xy.y * frame.t, frame.n};
}

float ShadowMapView::measure(const Vec2& position) const {
    const Vec2 p = 2.0f * position - 1.0f;
    // On the octahedron a direction w lies at w / |w|_1, on a face at the distance 1/sqrt(3), and the map
    // shows faces at a slant with a cosine of as much: dw = |w|_1^3 dx dy. [0, 1]^2 is 4 dx dy, the half of
    // it 2 dx dy.
    const auto face = [](const Vec3& w) {
        const float l1 = std::fabs(w.x) + std::fabs(w.y) + std::fabs(w.z);
        return l1 * l1 * l1;
    };
    const float square = 4.0f * half_extent * half_extent;
    switch (kind) {
        case Kind::octahedral:
            return 4.0f * face(octahedral_unproject(p));
        case Kind::hemispherical:
            return 2.0f * face(hemi_octahedral_unproject(p));
        case Kind::perspective: {
            const float slant = 1.0f + half_extent * half_extent * glm::dot(p, p);
            return square / (slant * std::sqrt(slant));  // cos^3
        }
        case Kind::parallel:
            break;
    }
    return square;
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
