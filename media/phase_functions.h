// The phase functions: isotropic and Henyey-Greenstein. Directions as in core/scene/phase_function.h.
#pragma once

#include "core/scene/phase_function.h"

namespace mote::core {
class Registry;
}

namespace mote::media {

/// 1 / (4 pi).
class IsotropicPhase final : public core::PhaseFunction {
  public:
    core::Rgb eval(const core::Vec3&, const core::Vec3&) const override {
        return core::Rgb(core::inv_four_pi);
    }
    float pdf_solid_angle(const core::Vec3&, const core::Vec3&) const override { return core::inv_four_pi; }
    core::PhaseSample sample(const core::Vec3& wo, const core::Vec2& u) const override;
    bool isotropic() const override { return true; }
    float mean_cosine() const override { return 0.0f; }
    std::optional<float> henyey_greenstein() const override { return 0.0f; }
};

/// With the mean cosine g (Henyey & Greenstein 1941).
class HenyeyGreensteinPhase final : public core::PhaseFunction {
  public:
    /// Throws InputError unless -1 < g < 1.
    explicit HenyeyGreensteinPhase(float g);
    core::Rgb eval(const core::Vec3& wo, const core::Vec3& wi) const override;
    float pdf_solid_angle(const core::Vec3& wo, const core::Vec3& wi) const override;
    core::PhaseSample sample(const core::Vec3& wo, const core::Vec2& u) const override;
    bool isotropic() const override { return g_ == 0.0f; }
    float mean_cosine() const override { return g_; }
    std::optional<float> henyey_greenstein() const override { return g_; }

  private:
    float g_;
};

void register_isotropic_phase(core::Registry& registry);  ///< <phase type="isotropic">.
void register_hg_phase(core::Registry& registry);         ///< <phase type="hg">.

}  // namespace mote::media
