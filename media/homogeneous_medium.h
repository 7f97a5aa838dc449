// A medium with the same coefficients everywhere: everything about it is analytic.
#pragma once

#include "core/scene/medium.h"

namespace mote::core {
class Registry;
}

namespace mote::media {

/// Constant coefficients.
class HomogeneousMedium final : public core::Medium {
  public:
    /// Coefficients in 1/m; `emitted_radiance` is the L_e [W/(m^2 sr)] that sigma_a multiplies. Throws
    /// InputError for negative or non-finite values and for sigma_s > sigma_t.
    HomogeneousMedium(const core::Rgb& sigma_t, const core::Rgb& sigma_s, const core::Rgb& emitted_radiance,
                      std::shared_ptr<core::PhaseFunction> phase);

    core::MediumTraits traits() const override;
    const core::PhaseFunction& phase() const override { return *phase_; }
    core::MediumCoefficients coefficients(const core::Vec3&) const override {
        return {sigma_t_, sigma_s_, emission_};
    }
    float majorant() const override { return core::max_component(sigma_t_); }
    /// All of space: the shapes that the medium fills limit it.
    core::Bounds3 bounds() const override;
    /// A source of particles alone: emission along a ray is integrated analytically, which no light sample
    /// betters.
    std::shared_ptr<core::Emitter> make_emitter(const core::Bounds3& box) override;
    std::optional<float> sample_collision(const core::Ray& ray, core::PathWeights& weights,
                                          core::Rgb& emitted, core::Rng& rng,
                                          core::TrackingCounters& counters) const override;
    /// In closed form; see Medium::scatter_along().
    void scatter_along(const core::Ray& ray, core::PathWeights& weights, core::Rgb& emitted,
                       core::ScatteringPoints& points, core::Rng& rng,
                       core::TrackingCounters& counters) const override;
    void connect(const core::Ray& ray, core::PathWeights& weights, core::Rng& rng,
                 core::TrackingCounters& counters) const override;
    core::Rgb transmittance(const core::Ray& ray, core::Rng& rng,
                            core::TrackingCounters& counters) const override;
    core::Vec3d optical_depth_along(const core::Ray& ray, float voxels,
                                    core::TrackingCounters& counters) const override;
    float marching_step(float, float) const override { return core::infinity; }

  private:
    void update_channel_weights(core::PathWeights& weights, double travelled, bool collides) const;

    core::Rgb sigma_t_, sigma_s_, emission_;  // emission_ = sigma_a * L_e
    bool absorbs_alone_;                      // sigma_s is zero
    std::shared_ptr<core::PhaseFunction> phase_;
};

void register_homogeneous_medium(core::Registry& registry);  ///< <medium type="homogeneous">.

}  // namespace mote::media
