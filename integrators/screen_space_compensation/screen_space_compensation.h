// Screen-space bias compensation at the end of a render (Engelhardt 2013, Ch. 11), for the light that
// surfaces reflect; light first scattered in media may be compensated by another method in the passes: the
// combination that Sec. 10.6 names as future work.
#pragma once

#include "compensation/compensation.h"
#include "screenspace/ssbc/ssbc.h"

namespace mote::integrators {

struct ScreenSpaceSettings {
    screenspace::SsbcSettings ssbc;  ///< but for the bound, which is that of the render
    int layers = 1;                  ///< of surfaces along a ray; 1: what the picture shows
    int vpl_share = 4;               ///< at each hidden point: one VPL of so many, in turn
};

class ScreenSpaceCompensation final : public compensation::Residual {
  public:
    /// `media`: compensation of receivers in media alone, in the passes.
    ScreenSpaceCompensation(const ScreenSpaceSettings& settings,
                            std::shared_ptr<const compensation::Residual> media)
        : settings_(settings), media_(std::move(media)) {}

    std::unique_ptr<compensation::PreparedResidual> prepare(
        const compensation::ResidualView& view) const override;
    /// Those of compensation, and auxiliary ones of the light that hidden sides reflect (hidden_light.h).
    std::vector<core::Layer> layers(bool media) const override;
    bool in_passes(bool surface) const override { return !surface && media_->restores(); }
    bool works_on_mean() const override { return true; }
    bool shares_vpls() const override { return media_->shares_vpls(); }
    int eye_samples() const override { return media_->eye_samples(); }
    void plan(core::Plan& plan, const core::Scene& scene, const core::Requirements& requirements,
              float bound) const override;

  private:
    ScreenSpaceSettings settings_;
    std::shared_ptr<const compensation::Residual> media_;
};

void register_screen_space_compensation(core::Registry& registry);

}  // namespace mote::integrators
