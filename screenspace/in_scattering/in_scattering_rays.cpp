#include "screenspace/in_scattering/in_scattering_rays.h"

#include <bit>

#include "core/scene/scene.h"

namespace mote::screenspace {

using namespace core;

InScatteringRays::InScatteringRays(const Scene& scene, const InScattering& light, const Vec2& u_lens)
    : InScatteringRays(scene, eye_view(scene), light, u_lens) {}

RayEnd lit_end(const InScattering& light, const Ray& ray, const FirstSurface& surface) {
    Ray to_surface = ray;
    to_surface.t_max = std::min(ray.t_max, surface.distance);
    const auto lit = light.lit_part(to_surface);
    if (!lit) return {};
    RayEnd end;
    end.distance = lit->t1;
    end.surface = surface.distance <= lit->t1;
    end.weight = float(light.unshadowed(ray, double(lit->t0), double(lit->t1)));
    if (!(end.weight > 0.0f)) return {};  // too short for single precision
    if (end.surface) end.position = ray.at(surface.distance), end.normal = surface.normal;
    return end;
}

class InScatteringRays::Task final : public InScatteringTask {
  public:
    explicit Task(const InScatteringRays& source) : source_(source) {}
    ~Task() override {
        const std::lock_guard lock(source_.mutex_);
        source_.rays_.add(scratch_.walk.rays), source_.tracking_.add(scratch_.walk.tracking);
        source_.marched_ += scratch_.rays, source_.steps_ += scratch_.steps;
        source_.unoccluded_ += scratch_.unoccluded;
    }

    Ray ray(const Vec2d& film) override {
        return source_.eye_.camera.sample_ray(Vec2(film), source_.u_lens_);
    }
    RayEnd end_of(const Vec2d& film) override {
        const Ray eye = ray(film);
        if (!source_.light_.lit_part(eye)) return {};  // dark whatever it meets
        ++scratch_.walk.rays.closest;
        const auto hit = source_.scene_.first_hit(eye);
        return lit_end(source_.light_, eye,
                       hit ? FirstSurface{hit->t, hit->geometric_normal} : FirstSurface{});
    }
    MarchedRay march(const Vec2d& film, const RayEnd& end) override {
        Ray eye = ray(film);
        eye.t_max = std::min(eye.t_max, end.distance);
        scratch_.walk.rng =
            Rng(hash_keys(std::bit_cast<std::uint64_t>(film.x), std::bit_cast<std::uint64_t>(film.y)));
        return source_.light_.march(eye, source_.eye_.media(eye), scratch_);
    }

  private:
    const InScatteringRays& source_;
    MarchScratch scratch_;
};

std::unique_ptr<InScatteringTask> InScatteringRays::start() const { return std::make_unique<Task>(*this); }

}  // namespace mote::screenspace
