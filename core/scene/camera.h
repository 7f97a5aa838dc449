// The interface of sensors: from a point on the film to a ray, and from a point of the scene to the film.
//
// Film positions are in pixels: x to the right in [0, width), y down in [0, height).
//
// A pixel j with filter density f_j (PixelFilter::pdf_area around its centre) has the value
//   I_j = int int f_j(x) L(ray(x, u)) dx du = int int W_e(y, w) f_j(x(y, w)) L(y, w) cos(w) dw dA(y),
// y on the lens and w into the scene. The second form defines the importance W_e [pixels / (m^2 sr)]: the
// Jacobian of sample_ray(), for the measurement equation (Veach 1997). It does not depend on the pixel, and
// over rays through the film W_e cos integrates to width * height. Where one ray is traced a pixel, rays have
// the density pdf_area * pdf_solid_angle = W_e cos, which is why each has the weight 1.
#pragma once

#include <memory>
#include <optional>

#include "core/math/ray.h"
#include "core/math/transform.h"
#include "core/objects/error.h"
#include "core/objects/object.h"

namespace mote::core {

class Medium;
class Film;

struct CameraTraits {
    bool delta_position = false;   ///< all rays start at one point: a pinhole
    bool delta_direction = false;  ///< all rays are parallel
};

/// The importance of a ray that leaves the camera.
struct RayImportance {
    Vec2 film_position;  ///< [pixels]
    float importance;  ///< W_e [pixels / (m^2 sr)]; without the part of the measure that is a delta, and for
                       ///< parallel rays per area perpendicular to them [pixels / m^2]
    float pdf_area;    ///< of the origin on the lens [1/m^2]; 1 for a delta position. Parallel rays: per area
                       ///< perpendicular to them, with one ray a pixel [pixels / m^2]
    float pdf_solid_angle;  ///< of the direction given the origin, with one ray a pixel [pixels / sr]; 1 for
                            ///< a delta direction
};

/// A connection from a point of the scene to the camera: the counterpart of DirectSample.
struct CameraSample {
    Vec3 wi;             ///< unit, from the point to the camera
    float distance;      ///< to `origin` [m]
    Vec3 origin;         ///< where the ray through the point starts
    float t_min;         ///< the near clipping plane, in distance from `origin`: nothing nearer hides or dims
    Vec2 film_position;  ///< [pixels]
    float weight;  ///< W_e / pdf, with the cosine at the camera where there is no pdf; without visibility,
                   ///< transmittance and the point's own cosine
    float pdf_solid_angle;  ///< at the point; 0 for delta cameras (then weight is the full value)
    bool delta = false;     ///< the camera is a pinhole
};

/// Where eye rays begin and go, and its adjoint.
class Camera : public Object {
  public:
    /// The ray through `film_position`; `u_lens` chooses the point on a lens. t_min and t_max hold the near
    /// and far clipping planes. The weight of every ray is 1.
    virtual Ray sample_ray(const Vec2& film_position, const Vec2& u_lens) const = 0;

    /// Parts that are deltas.
    virtual CameraTraits traits() const = 0;

    /// The importance of a ray from `origin` on the lens, unit `direction` into the scene. A delta part is
    /// taken to be the camera's own. Nothing where no ray of the camera leaves so, or where it belongs to a
    /// place more than `margin` pixels outside of the film: pixels at the border see as far as their filter
    /// reaches (PixelFilter::radius). Ignores the clipping planes, which end rays, not directions.
    virtual std::optional<RayImportance> importance(const Vec3& origin, const Vec3& direction,
                                                    float margin) const = 0;

    /// Connects p to the point on the lens that `u_lens` chooses, the same as in sample_ray(). Nothing where
    /// p lies outside of the clipping planes or is seen more than `margin` pixels outside of the film.
    virtual std::optional<CameraSample> sample_importance(const Vec3& p, const Vec2& u_lens,
                                                          float margin) const = 0;

    /// Where on the film p is seen through the middle of the lens; nothing as for sample_importance().
    std::optional<Vec2> project(const Vec3& p, float margin = 0.0f) const {
        const auto sample = sample_importance(p, Vec2(0.5f), margin);
        return sample ? std::optional<Vec2>(sample->film_position) : std::nullopt;
    }

    /// Where the camera stands: used to find the medium around it and for metadata.
    virtual Vec3 position() const = 0;
    virtual Transform to_world() const = 0;

    std::shared_ptr<Medium> medium;  ///< the medium around the camera where the scene file names one
    SourceLocation medium_where;     ///< of that name
};

}  // namespace mote::core
