// The pinhole camera.
#include "core/cameras/sensors.h"

namespace mote::core {
namespace {

struct PerspectiveSettings : SensorSettings {
    ViewSettings view;
};

class PerspectiveCamera final : public Camera {
  public:
    PerspectiveCamera(const PerspectiveSettings& s, const Properties& p)
        : view_(s.film, s.view, p),
          clip_(clip_planes(s, p)),
          to_world_(rigid_to_world(s.to_world, p)),
          to_camera_(to_world_.inverse()),
          origin_(to_world_.point(Vec3d(0.0))) {}

    Ray sample_ray(const Vec2& film_position, const Vec2& /*u_lens*/) const override {
        const Vec3 local = view_.direction(film_position);
        // The clipping planes are perpendicular to the view: farther along slanted rays.
        const float slant = glm::length(local);
        const Vec3 direction(glm::normalize(to_world_.vector(Vec3d(local))));
        return {origin_, direction, clip_.near * slant, clip_.far * slant};
    }
    CameraTraits traits() const override { return {.delta_position = true}; }

    std::optional<RayImportance> importance(const Vec3& /*origin*/, const Vec3& direction,
                                            float margin) const override {
        const Vec3d local = to_camera_.vector(Vec3d(direction));
        if (!(local.z > 0.0)) return std::nullopt;
        const Vec2 film = view_.film_position(local);
        if (!view_.on_film(film, margin)) return std::nullopt;
        const double cosine = local.z / glm::length(local), pixels = view_.pixels_per_solid_angle(cosine);
        return RayImportance{film, float(pixels / cosine), 1.0f, float(pixels)};
    }
    std::optional<CameraSample> sample_importance(const Vec3& p, const Vec2& /*u_lens*/,
                                                  float margin) const override {
        const Vec3d local = to_camera_.point(Vec3d(p));
        if (!(local.z > double(clip_.near) && local.z < double(clip_.far))) return std::nullopt;
        const Vec2 film = view_.film_position(local);
        if (!view_.on_film(film, margin)) return std::nullopt;
        const Vec3d d = Vec3d(origin_) - Vec3d(p);
        const double distance = glm::length(d), slant = glm::length(local) / local.z;
        // W_e cos / d^2
        const double weight = view_.pixels_per_solid_angle(1.0 / slant) / (distance * distance);
        return CameraSample{.wi = Vec3(d / distance),
                            .distance = float(distance),
                            .origin = origin_,
                            .t_min = float(double(clip_.near) * slant),
                            .film_position = film,
                            .weight = float(weight),
                            .pdf_solid_angle = 0.0f,
                            .delta = true};
    }
    Vec3 position() const override { return origin_; }
    Transform to_world() const override { return to_world_; }

  private:
    PinholeView view_;
    ClipPlanes clip_;
    Transform to_world_, to_camera_;
    Vec3 origin_;
};

}  // namespace

void register_perspective(Registry& registry) {
    add_type<PerspectiveSettings>(registry, Category::sensor, "perspective", "A pinhole camera.",
                                  {within(&PerspectiveSettings::view, view_rows()), sensor_rows()},
                                  R"(<sensor type="perspective">
    <float name="fov" value="45"/>
    <transform name="to_world"><lookat origin="0, 1, 4" target="0, 1, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="640"/><integer name="height" value="480"/></film>
</sensor>)",
                                  [](const PerspectiveSettings& s, const Properties& p) {
                                      return std::make_shared<PerspectiveCamera>(s, p);
                                  });
}

}  // namespace mote::core
