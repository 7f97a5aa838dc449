// The pinhole camera.
#include "core/cameras/sensors.h"

namespace mote::core {
namespace {

class PerspectiveCamera final : public Camera {
  public:
    explicit PerspectiveCamera(const Properties& p)
        : view_(p),
          clip_(clip_planes(p)),
          to_world_(rigid_to_world(p)),
          origin_(to_world_.point(Vec3d(0.0))) {}

    Ray sample_ray(const Vec2& film_position, const Vec2& /*u_lens*/) const override {
        const Vec3 local = view_.direction(film_position);
        // The clipping planes are perpendicular to the view: farther along slanted rays.
        const float slant = glm::length(local);
        const Vec3 direction(glm::normalize(to_world_.vector(Vec3d(local))));
        return {origin_, direction, clip_.near * slant, clip_.far * slant};
    }
    Vec3 position() const override { return origin_; }
    Transform to_world() const override { return to_world_; }

  private:
    PinholeView view_;
    ClipPlanes clip_;
    Transform to_world_;
    Vec3 origin_;
};

}  // namespace

void register_perspective(Registry& registry) {
    Manual manual{Category::sensor, "perspective", "A pinhole camera.", {}, R"(<sensor type="perspective">
    <float name="fov" value="45"/>
    <transform name="to_world"><lookat origin="0, 1, 4" target="0, 1, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="640"/><integer name="height" value="480"/></film>
</sensor>)"};
    add_view_parameters(manual.parameters);
    add_common_parameters(manual.parameters);
    registry.add(std::move(manual),
                 [](const Properties& p) { return std::make_shared<PerspectiveCamera>(p); });
}

}  // namespace mote::core
