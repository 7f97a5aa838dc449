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

/// A pinhole view: film positions to directions in camera space with z = 1. +X is to the picture's left.
struct PinholeView {
    float width, height;            ///< pixels
    float half_width, half_height;  ///< of the picture at distance 1

    explicit PinholeView(const Properties& properties);
    Vec3 direction(const Vec2& film_position) const {
        return {half_width * (1.0f - 2.0f * film_position.x / width),
                half_height * (1.0f - 2.0f * film_position.y / height), 1.0f};
    }
};

}  // namespace mote::core
