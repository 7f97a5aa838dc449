#include "screenspace/in_scattering/shared_eye_rays.h"

#include <algorithm>
#include <bit>

#include "core/scene/scene.h"
#include "screenspace/in_scattering/eye_media.h"
#include "screenspace/in_scattering/in_scattering_rays.h"

namespace mote::screenspace {

using namespace core;

class SharedEyeRays::Task final : public SharedRayTask {
  public:
    explicit Task(const SharedEyeRays& source) : source_(source) {}
    ~Task() override {
        const std::lock_guard lock(source_.mutex_);
        MarchScratch& done = source_.done_;
        done.walk.rays.add(scratch_.walk.rays), done.walk.tracking.add(scratch_.walk.tracking);
        done.rays += scratch_.rays, done.steps += scratch_.steps, done.unoccluded += scratch_.unoccluded;
    }

    Ray ray(const Vec2d& film) override {
        return source_.eye_.camera.sample_ray(Vec2(film), source_.u_lens_);
    }
    std::array<RayEnd, 2> ends_of(const Crossing& crossing) override {
        const Ray eye = ray(crossing.film);
        ++scratch_.walk.rays.closest;
        const auto hit = source_.scene_.first_hit(eye);
        const FirstSurface surface = hit ? FirstSurface{hit->t, hit->geometric_normal} : FirstSurface{};
        return {lit_end(light(crossing, 0), eye, surface), lit_end(light(crossing, 1), eye, surface)};
    }
    std::array<MarchedRay, 2> march(const Crossing& crossing, const std::array<RayEnd, 2>& ends) override {
        scratch_.walk.rng = Rng(hash_keys(std::bit_cast<std::uint64_t>(crossing.film.x),
                                          std::bit_cast<std::uint64_t>(crossing.film.y)));
        Ray eye = ray(crossing.film);
        const MediumState state = source_.eye_.media(eye);
        const float reach = eye.t_max;
        eye.t_max = std::min(reach, std::max(ends[0].distance, ends[1].distance));
        const EyeMedia media(source_.scene_, eye, state, source_.voxels_, scratch_.walk);
        std::array<MarchedRay, 2> marched;
        for (std::size_t i = 0; i < 2; ++i) {
            eye.t_max = std::min(reach, ends[i].distance);
            marched[i] = light(crossing, i).march(eye, state, scratch_, &media);
        }
        return marched;
    }

  private:
    const InScattering& light(const Crossing& crossing, std::size_t side) const {
        return *source_.lights_[crossing.sides[side].light];
    }

    const SharedEyeRays& source_;
    MarchScratch scratch_;
};

SharedEyeRays::SharedEyeRays(const Scene& scene, std::span<const InScattering* const> lights, float voxels,
                             const Vec2& u_lens)
    : SharedEyeRays(scene, eye_view(scene), lights, voxels, u_lens) {}

std::unique_ptr<SharedRayTask> SharedEyeRays::start() const { return std::make_unique<Task>(*this); }

}  // namespace mote::screenspace
