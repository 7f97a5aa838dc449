// Parallel projection: the picture is the square [-1, 1] (in x) of the camera's own space, so that the size
// of the view is set by a scale in to_world.
#include "core/cameras/film_objects.h"
#include "core/cameras/sensors.h"

namespace mote::core {
namespace {

class OrthographicCamera final : public Camera {
  public:
    explicit OrthographicCamera(const Properties& p) : clip_(clip_planes(p)), to_world_(p.get_transform()) {
        const FilmObject film = film_of_sensor(p);
        width_ = float(film.width), height_ = float(film.height);
        direction_ = Vec3(glm::normalize(to_world_.vector(Vec3d(0, 0, 1))));
    }

    Ray sample_ray(const Vec2& film_position, const Vec2& /*u_lens*/) const override {
        const Vec3d local(1.0 - 2.0 * double(film_position.x / width_),
                          (1.0 - 2.0 * double(film_position.y / height_)) * double(height_ / width_), 0.0);
        return {Vec3(to_world_.point(local)), direction_, clip_.near, clip_.far};
    }
    Vec3 position() const override { return Vec3(to_world_.point(Vec3d(0.0))); }
    Transform to_world() const override { return to_world_; }

  private:
    ClipPlanes clip_;
    Transform to_world_;
    Vec3 direction_{0, 0, 1};
    float width_ = 1.0f, height_ = 1.0f;
};

}  // namespace

void register_orthographic(Registry& registry) {
    Manual manual{Category::sensor,
                  "orthographic",
                  "Parallel projection of [-1, 1] in x; a scale in to_world sets the size of the view.",
                  {},
                  R"(<sensor type="orthographic">
    <transform name="to_world"><scale x="5" y="5"/><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
</sensor>)"};
    add_common_parameters(manual.parameters);
    registry.add(std::move(manual),
                 [](const Properties& p) { return std::make_shared<OrthographicCamera>(p); });
}

}  // namespace mote::core
