// A camera with a thin lens: sharp on the plane of focus, blurred before and behind it.
#include "core/cameras/sensors.h"
#include "core/math/warp.h"

namespace mote::core {
namespace {

class ThinLensCamera final : public Camera {
  public:
    explicit ThinLensCamera(const Properties& p)
        : view_(p),
          clip_(clip_planes(p)),
          to_world_(rigid_to_world(p)),
          origin_(to_world_.point(Vec3d(0.0))) {
        const double radius = p.require_float("aperture_radius");
        if (!(radius > 0.0))
            throw InputError("'aperture_radius' must be positive; 'perspective' is the camera without a lens",
                             p.where_of("aperture_radius"));
        const double focus = p.get_float("focus_distance", double(clip_.far));
        if (!(focus > 0.0))
            throw InputError("'focus_distance' must be positive", p.where_of("focus_distance"));
        radius_ = float(radius), focus_ = float(focus);
    }

    Ray sample_ray(const Vec2& film_position, const Vec2& u_lens) const override {
        const Vec3 in_focus = focus_ * view_.direction(film_position);
        const Vec3 on_lens(radius_ * square_to_disk(u_lens), 0.0f);
        const Vec3 local = in_focus - on_lens;
        const float slant = glm::length(local) / local.z;
        const Vec3 direction(glm::normalize(to_world_.vector(Vec3d(local))));
        return {Vec3(to_world_.point(Vec3d(on_lens))), direction, clip_.near * slant, clip_.far * slant};
    }
    Vec3 position() const override { return origin_; }
    Transform to_world() const override { return to_world_; }

  private:
    PinholeView view_;
    ClipPlanes clip_;
    Transform to_world_;
    Vec3 origin_;
    float radius_ = 0.0f, focus_ = 1.0f;
};

}  // namespace

void register_thinlens(Registry& registry) {
    Manual manual{
        Category::sensor, "thinlens", "A camera with depth of field.", {}, R"(<sensor type="thinlens">
    <float name="fov" value="45"/>
    <float name="aperture_radius" value="0.05"/>
    <float name="focus_distance" value="3"/>
</sensor>)"};
    manual.parameters.push_back({"aperture_radius", "float", "required", "of the lens, m"});
    manual.parameters.push_back(
        {"focus_distance", "float", "far_clip", "from the lens to the plane of focus, m along the view"});
    add_view_parameters(manual.parameters);
    add_common_parameters(manual.parameters);
    registry.add(std::move(manual), [](const Properties& p) { return std::make_shared<ThinLensCamera>(p); });
}

}  // namespace mote::core
