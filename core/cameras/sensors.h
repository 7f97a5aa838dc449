// What the sensors share: the field of view, the frame of a camera, and one registration each.
#pragma once

#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "core/scene/camera.h"

namespace mote::core {

void register_perspective(Registry& registry);
void register_thinlens(Registry& registry);
void register_orthographic(Registry& registry);

/// Near and far clipping plane, along the viewing direction [m].
struct ClipPlanes {
    float near, far;
};
/// near_clip (1e-2) and far_clip (1e4). Throws InputError unless 0 < near < far.
ClipPlanes clip_planes(const Properties& properties);
/// The rows of a manual page for them.
void add_common_parameters(std::vector<Parameter>& parameters);
void add_view_parameters(std::vector<Parameter>& parameters);

/// Width of the picture at distance 1 over two, tan(fov_x / 2), from fov and fov_axis, or focal_length;
/// `aspect` is width over height. Throws InputError when both are given or the angle is not inside (0, 180)
/// degrees.
double tan_half_fov_x(const Properties& properties, double aspect);
/// to_world. Throws InputError when it scales or shears; a mirror is allowed, as in Mitsuba 3.
Transform rigid_to_world(const Properties& properties);

/// Is a film position on the film of `size` pixels, or at most `margin` pixels off?
inline bool on_film(const Vec2& film_position, const Vec2& size, float margin) {
    return film_position.x >= -margin && film_position.x < size.x + margin && film_position.y >= -margin &&
           film_position.y < size.y + margin;
}

/// A pinhole view: film positions to directions in camera space with z = 1. +X is to the picture's left.
struct PinholeView {
    float width, height;            ///< pixels
    float half_width, half_height;  ///< of the picture at distance 1

    explicit PinholeView(const Properties& properties);
    Vec3 direction(const Vec2& film_position) const {
        return {half_width * (1.0f - 2.0f * film_position.x / width),
                half_height * (1.0f - 2.0f * film_position.y / height), 1.0f};
    }
    /// The inverse, for camera-space directions of any length with z > 0.
    Vec2 film_position(const Vec3d& direction) const {
        return {0.5 * double(width) * (1.0 - direction.x / (double(half_width) * direction.z)),
                0.5 * double(height) * (1.0 - direction.y / (double(half_height) * direction.z))};
    }
    /// Jacobian from directions to the film at the cosine with the view [pixels/sr]. The picture at distance
    /// 1 has the area 4 half_width half_height, of which dw covers dw / cos^3.
    double pixels_per_solid_angle(double cosine) const {
        return double(width) * double(height) /
               (4.0 * double(half_width) * double(half_height) * cosine * cosine * cosine);
    }
    bool on_film(const Vec2& film_position, float margin) const {
        return core::on_film(film_position, {width, height}, margin);
    }
};

}  // namespace mote::core
