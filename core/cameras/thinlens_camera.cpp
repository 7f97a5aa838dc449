// A camera with a thin lens: sharp on the plane of focus, blurred before and behind it.
#include "core/cameras/sensors.h"
#include "core/math/warp.h"

namespace mote::core {
namespace {

struct ThinLensSettings : SensorSettings {
    ViewSettings view;
    float aperture_radius = 0.0f;
    std::optional<float> focus_distance;
};

class ThinLensCamera final : public Camera {
  public:
    ThinLensCamera(const ThinLensSettings& s, const Properties& p)
        : view_(s.film, s.view, p),
          clip_(clip_planes(s, p)),
          to_world_(rigid_to_world(s.to_world, p)),
          to_camera_(to_world_.inverse()),
          origin_(to_world_.point(Vec3d(0.0))),
          radius_(s.aperture_radius),
          focus_(s.focus_distance.value_or(clip_.far)) {}

    Ray sample_ray(const Vec2& film_position, const Vec2& u_lens) const override {
        const Vec3 in_focus = focus_ * view_.direction(film_position);
        const Vec3 on_lens = point_on_lens(u_lens);
        const Vec3 local = in_focus - on_lens;
        const float slant = glm::length(local) / local.z;
        const Vec3 direction(glm::normalize(to_world_.vector(Vec3d(local))));
        return {Vec3(to_world_.point(Vec3d(on_lens))), direction, clip_.near * slant, clip_.far * slant};
    }
    CameraTraits traits() const override { return {}; }

    std::optional<RayImportance> importance(const Vec3& origin, const Vec3& direction,
                                            float margin) const override {
        const Vec3d local = to_camera_.vector(Vec3d(direction));
        if (!(local.z > 0.0)) return std::nullopt;
        const Vec2 film = film_position(to_camera_.point(Vec3d(origin)), local);
        if (!view_.on_film(film, margin)) return std::nullopt;
        const double cosine = local.z / glm::length(local), pixels = view_.pixels_per_solid_angle(cosine);
        return RayImportance{film, float(pixels / (lens_area() * cosine)), float(1.0 / lens_area()),
                             float(pixels)};
    }
    std::optional<CameraSample> sample_importance(const Vec3& p, const Vec2& u_lens,
                                                  float margin) const override {
        const Vec3d on_lens(point_on_lens(u_lens)), local = to_camera_.point(Vec3d(p)) - on_lens;
        if (!(local.z > double(clip_.near) && local.z < double(clip_.far))) return std::nullopt;
        const Vec2 film = film_position(on_lens, local);
        if (!view_.on_film(film, margin)) return std::nullopt;
        const Vec3d origin = to_world_.point(on_lens), d = origin - Vec3d(p);
        const double distance = glm::length(d), slant = glm::length(local) / local.z;
        // From the area of the lens to directions at p: d^2 / (A cos).
        const double pdf = distance * distance * slant / lens_area();
        const double importance = view_.pixels_per_solid_angle(1.0 / slant) * slant / lens_area();
        return CameraSample{.wi = Vec3(d / distance),
                            .distance = float(distance),
                            .origin = Vec3(origin),
                            .t_min = float(double(clip_.near) * slant),
                            .film_position = film,
                            .weight = float(importance / pdf),
                            .pdf_solid_angle = float(pdf)};
    }
    Vec3 position() const override { return origin_; }
    Transform to_world() const override { return to_world_; }

  private:
    Vec3 point_on_lens(const Vec2& u) const { return {radius_ * square_to_disk(u), 0.0f}; }
    double lens_area() const { return double(pi) * double(radius_) * double(radius_); }
    /// Film position of the ray from `on_lens` along `direction` (camera space): rays to one point in focus
    /// belong together.
    Vec2 film_position(const Vec3d& on_lens, const Vec3d& direction) const {
        const double focus(focus_);
        const Vec3d in_focus = on_lens + direction * (focus / direction.z);
        return view_.film_position({in_focus.x, in_focus.y, focus});
    }

    PinholeView view_;
    ClipPlanes clip_;
    Transform to_world_, to_camera_;
    Vec3 origin_;
    float radius_, focus_;
};

}  // namespace

void register_thinlens(Registry& registry) {
    add_type<ThinLensSettings>(registry, Category::sensor, "thinlens", "A camera with depth of field.",
                               {row("aperture_radius", &ThinLensSettings::aperture_radius, above(0, "m"),
                                    "Radius of the lens; 'perspective' is the camera without one.")
                                    .required(),
                                row("focus_distance", &ThinLensSettings::focus_distance, above(0, "m"),
                                    "From the lens to the plane of focus, along the view.")
                                    .when_absent("far_clip"),
                                within(&ThinLensSettings::view, view_rows()), sensor_rows()},
                               R"(<sensor type="thinlens">
    <float name="fov" value="45"/>
    <float name="aperture_radius" value="0.05"/>
    <float name="focus_distance" value="3"/>
</sensor>)",
                               [](const ThinLensSettings& s, const Properties& p) {
                                   return std::make_shared<ThinLensCamera>(s, p);
                               });
}

}  // namespace mote::core
