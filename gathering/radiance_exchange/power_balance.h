// Scales indirect light so that its power is the one at which as much arrives as is sent.
//
// Of each channel: what arrived, sum A E_i, is the fraction kappa of what was sent, sum A rho (E_d + E_i
// before). If E_i keeps its shape, and kappa, the fixed point has the factor
//   alpha sum A E_i = kappa sum A rho (E_d + alpha E_i).
// This is where the part of the iteration converges to that would take longest.
#pragma once

#include "gathering/radiance_exchange/exchange_batch.h"

namespace mote::gathering {

class PowerBalance {
  public:
    /// Before a batch: direct light, and the indirect light that is sent with it.
    PowerBalance(const ExchangeScene& scene, const std::vector<core::Rgb>& direct,
                 const std::vector<core::Rgb>& indirect)
        : scene_(scene), direct_(reflected(direct)), sent_(direct_ + reflected(indirect)) {}

    /// After it, of what it received.
    void scale(std::vector<core::Rgb>& received) const {
        const core::Vec3d arrived = sum(received, [](const TexelMaterial&) { return core::Rgb(1.0f); });
        const core::Vec3d kept = reflected(received);
        core::Rgb alpha(1.0f);
        for (int c = 0; c < 3; ++c) {
            if (!(sent_[c] > 0.0 && arrived[c] > 0.0)) continue;
            const double kappa = arrived[c] / sent_[c];
            const double left = arrived[c] - kappa * kept[c];
            // Without losses there is no fixed point; far from one, kappa is not known well enough.
            if (left > 0.01 * arrived[c]) alpha[c] = float(kappa * direct_[c] / left);
        }
        for (core::Rgb& e : received) e *= alpha;
    }

  private:
    template <typename Weight>
    core::Vec3d sum(const std::vector<core::Rgb>& irradiance, const Weight& weight) const {
        core::Vec3d total(0.0);
        const auto texels = scene_.atlas.texels();
        for (std::size_t t = 0; t < irradiance.size(); ++t)
            total += core::Vec3d(weight(scene_.materials.of[t]) * irradiance[t] * texels[t].area);
        return total;
    }
    core::Vec3d reflected(const std::vector<core::Rgb>& irradiance) const {
        return sum(irradiance, [](const TexelMaterial& m) { return m.reflectance; });
    }

    const ExchangeScene& scene_;
    core::Vec3d direct_, sent_;  ///< reflected power [W]
};

}  // namespace mote::gathering
