// Shared by the sensors: the field of view, the frame of a camera, and one registration each.
#pragma once

#include "core/cameras/film_objects.h"
#include "core/scene/camera.h"
#include "core/scene/scene.h"

namespace mote::core {

void register_perspective(Registry& registry);
void register_thinlens(Registry& registry);
void register_orthographic(Registry& registry);

/// Parameters that all sensors share.
struct SensorSettings {
    Transform to_world;                       ///< camera to world
    double near_clip = 1e-2, far_clip = 1e4;  ///< along the view [m]
    FilmFormat film;
    SamplerSettings sampler;
    std::vector<Nested<Medium>> medium;  ///< attached by the scene loader
};
const ParameterList<SensorSettings>& sensor_rows();

/// The film, filter and sampler of a sensor as settings of a scene.
FilmSettings film_settings(const Properties& sensor);

/// Near and far clipping plane, along the viewing direction [m].
struct ClipPlanes {
    float near, far;
};
/// Throws InputError unless near < far.
ClipPlanes clip_planes(const SensorSettings& settings, const Properties& properties);

enum class FovAxis : std::uint8_t { x, y, diagonal, smaller, larger };

/// The field of view.
struct ViewSettings {
    std::optional<double> fov;  ///< along the axis [degrees]; else by the focal length
    FovAxis axis = FovAxis::x;
    std::string focal_length = "50mm";  ///< on 35 mm film
};
const ParameterList<ViewSettings>& view_rows();

/// Width of the image at distance 1 over two, tan(fov_x / 2); `aspect` is width over height. Throws
/// InputError when both fov and focal_length are given.
double tan_half_fov_x(const ViewSettings& view, double aspect, const Properties& properties);
/// The transform itself. Throws InputError when it scales or shears; a mirror is allowed, as in Mitsuba 3.
Transform rigid_to_world(const Transform& to_world, const Properties& properties);

/// True if a film position is on the film of `size` pixels, or at most `margin` pixels off.
inline bool on_film(const Vec2& film_position, const Vec2& size, float margin) {
    return film_position.x >= -margin && film_position.x < size.x + margin && film_position.y >= -margin &&
           film_position.y < size.y + margin;
}

/// A pinhole view: film positions to directions in camera space with z = 1. +X is to the picture's left.
struct PinholeView {
    float width, height;            ///< pixels
    float half_width, half_height;  ///< of the picture at distance 1

    PinholeView(const FilmFormat& film, const ViewSettings& view, const Properties& properties);
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
