#include "lights/shadow_map_view.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

namespace {

/// Four texels of a plain square, clamped at its edges.
BilinearFootprint plane_footprint(const Vec2& uv, int size) {
    const TexelCell c(uv, size, size);
    const int left = std::max(c.i, 0), right = std::min(c.i + 1, size - 1);
    const int low = std::max(c.j, 0) * size, high = std::min(c.j + 1, size - 1) * size;
    return {{low + left, low + right, high + left, high + right}, c.weights()};
}

bool inside_square(const Vec2& uv) { return uv.x >= 0.0f && uv.x <= 1.0f && uv.y >= 0.0f && uv.y <= 1.0f; }

}  // namespace

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

std::optional<ShadowMapView::Place> ShadowMapView::place(const Vec3& p) const {
    const Vec3 d = frame.to_local(p - origin);
    if (kind == Kind::parallel) {
        const Vec2 uv = 0.5f * (Vec2(d.x, d.y) / half_extent) + 0.5f;
        if (!inside_square(uv) || !(d.z >= 0.0f)) return std::nullopt;
        return Place{plane_footprint(uv, size), d.z};
    }
    const float distance = glm::length(d);
    if (!(distance > 0.0f)) return std::nullopt;
    if (kind == Kind::octahedral) return Place{OctahedralMap{size}.footprint(d), distance};
    if (!(d.z > 0.0f)) return std::nullopt;
    if (kind == Kind::hemispherical) return Place{HemiOctahedralMap{size}.footprint(d), distance};
    const Vec2 uv = 0.5f * (Vec2(d.x, d.y) / (d.z * half_extent)) + 0.5f;
    if (!inside_square(uv)) return std::nullopt;
    return Place{plane_footprint(uv, size), distance};
}

float ShadowMapView::texel_angle() const {
    switch (kind) {
        case Kind::octahedral:
            return std::sqrt(4.0f * pi / float(texels()));
        case Kind::hemispherical:
            return std::sqrt(2.0f * pi / float(texels()));
        case Kind::perspective:
            return 2.0f * half_extent / float(size);
        case Kind::parallel:
            break;
    }
    return 0.0f;
}

}  // namespace mote::lights
