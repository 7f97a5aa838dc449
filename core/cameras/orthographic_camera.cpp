// Parallel projection: the picture is the square [-1, 1] (in x) of the camera's own space, so that the size
// of the view is set by a scale in to_world.
#include "core/cameras/sensors.h"

namespace mote::core {
namespace {

class OrthographicCamera final : public Camera {
  public:
    OrthographicCamera(const SensorSettings& s, const Properties& p)
        : clip_(clip_planes(s, p)),
          to_world_(s.to_world),
          to_camera_(to_world_.inverse()),
          width_(float(s.film.width)),
          height_(float(s.film.height)) {
        const Vec3d along = to_world_.vector(Vec3d(0, 0, 1));
        depth_ = glm::length(along);
        direction_ = Vec3(along / depth_);
        // The picture's area as its rays see it: a to_world that shears tilts the picture against them.
        const Vec3d across = to_world_.vector(Vec3d(2, 0, 0)),
                    down = to_world_.vector(Vec3d(0, 2.0 * double(height_ / width_), 0));
        pixels_per_area_ = float(double(width_) * double(height_) /
                                 std::fabs(glm::dot(glm::cross(across, down), along / depth_)));
    }

    Ray sample_ray(const Vec2& film_position, const Vec2& /*u_lens*/) const override {
        const Vec3d local(1.0 - 2.0 * double(film_position.x / width_),
                          (1.0 - 2.0 * double(film_position.y / height_)) * double(height_ / width_), 0.0);
        return {Vec3(to_world_.point(local)), direction_, clip_.near, clip_.far};
    }
    CameraTraits traits() const override { return {.delta_direction = true}; }

    std::optional<RayImportance> importance(const Vec3& origin, const Vec3& /*direction*/,
                                            float margin) const override {
        const Vec2 film = film_position(to_camera_.point(Vec3d(origin)));
        if (!on_film(film, {width_, height_}, margin)) return std::nullopt;
        return RayImportance{film, pixels_per_area_, pixels_per_area_, 1.0f};
    }
    std::optional<CameraSample> sample_importance(const Vec3& p, const Vec2& /*u_lens*/,
                                                  float margin) const override {
        const Vec3d local = to_camera_.point(Vec3d(p));
        const double distance = local.z * depth_;
        if (!(distance > double(clip_.near) && distance < double(clip_.far))) return std::nullopt;
        const Vec2 film = film_position(local);
        if (!on_film(film, {width_, height_}, margin)) return std::nullopt;
        return CameraSample{.wi = -direction_,
                            .distance = float(distance),
                            .origin = Vec3(to_world_.point({local.x, local.y, 0.0})),
                            .t_min = clip_.near,
                            .film_position = film,
                            .weight = pixels_per_area_,
                            .pdf_solid_angle = 0.0f,
                            .delta = true};
    }
    Vec3 position() const override { return Vec3(to_world_.point(Vec3d(0.0))); }
    Transform to_world() const override { return to_world_; }

  private:
    Vec2 film_position(const Vec3d& local) const {
        return {0.5 * double(width_) * (1.0 - local.x),
                0.5 * double(height_) * (1.0 - local.y * double(width_ / height_))};
    }

    ClipPlanes clip_;
    Transform to_world_, to_camera_;
    float width_, height_;
    Vec3 direction_{0, 0, 1};
    double depth_ = 1.0;            ///< length of the camera's z axis in the world
    float pixels_per_area_ = 0.0f;  ///< perpendicular to the rays [pixels/m^2]
};

}  // namespace

void register_orthographic(Registry& registry) {
    add_type(registry, Category::sensor, "orthographic",
             "Parallel projection of [-1, 1] in x; a scale in to_world sets the size of the view.",
             sensor_rows(), R"(<sensor type="orthographic">
    <transform name="to_world"><scale x="5" y="5"/><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
</sensor>)",
             [](const SensorSettings& s, const Properties& p) {
                 return std::make_shared<OrthographicCamera>(s, p);
             });
}

}  // namespace mote::core
