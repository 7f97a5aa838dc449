// Bias compensation in the passes, exact or approximate, from the primary lights and from the VPLs
// (Kollig and Keller 2006; Raab et al. 2008; Engelhardt 2013, Sec. 10.2).
#pragma once

#include "compensation/compensation_settings.h"
#include "compensation/residual.h"
#include "core/objects/registry.h"

namespace mote::compensation {

class Compensation final : public Residual {
  public:
    explicit Compensation(const CompensationSettings& settings) : settings_(settings) {}
    const CompensationSettings& settings() const { return settings_; }

    std::unique_ptr<PreparedResidual> prepare(const ResidualView& view) const override;
    std::vector<core::Layer> layers(bool media) const override { return compensation_layers(media); }
    bool in_passes(bool) const override { return true; }
    bool shares_vpls() const override { return settings_.strategy == Strategy::one_to_one; }
    int eye_samples() const override { return shares_vpls() ? 4 : 1; }
    void plan(core::Plan& plan, const core::Scene& scene, const core::Requirements& requirements,
              float bound) const override;

  private:
    CompensationSettings settings_;
};

/// none, exact, approximate.
void register_compensation(core::Registry& registry);

}  // namespace mote::compensation
