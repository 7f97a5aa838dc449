// Light that the points of media scatter: by node its power, and which way it goes.
//
// What a point scatters is kept by two moments: how much, and in which direction how strongly. With the phase
// function of Henyey and Greenstein they are exact for light from one direction, and for all light where it
// is isotropic. Several directions are one lobe of the same mean cosine: Henyey-Greenstein functions of g and
// r convolve to that of g r, their Legendre coefficients being powers of g.
#pragma once

#include "gathering/volume_points/volume_points.h"

namespace mote::gathering {

/// Light that arrives at a point of a medium from everywhere.
struct Fluence {
    core::Rgb amount{0.0f};  ///< integral of radiance over directions [W/m^2]
    core::Vec3 flow{0.0f};   ///< of its channels' average times the direction in which it travels [W/m^2]

    Fluence operator+(const Fluence& o) const { return {amount + o.amount, flow + o.flow}; }
    Fluence operator*(float s) const { return {s * amount, s * flow}; }
    /// Light of this radiance [W/(m^2 sr)] from the directions `towards`, over a solid angle [sr].
    void add(const core::Rgb& radiance, const core::Vec3& towards, float solid_angle) {
        amount += solid_angle * radiance, flow -= solid_angle * core::average(radiance) * towards;
    }
};

class VolumeLight {
  public:
    static constexpr std::size_t bytes_per_point = 2 * (sizeof(core::Rgb) + sizeof(core::Vec3) + 4);
    /// `fluence` by point. The phase functions are those of the points' media; of one that is not
    /// Henyey-Greenstein's, that of its mean cosine. Throws InputError where the sizes differ or a value is
    /// not finite.
    VolumeLight(const VolumeHierarchy& hierarchy, const VolumePoints& points,
                std::span<const Fluence> fluence);

    /// Intensity of all points below a node, towards `direction` (unit) [W/sr].
    core::Rgb intensity(std::uint32_t node, const core::Vec3& direction) const {
        const Lobe& lobe = lobes_[node];
        if (lobe.g == 0.0f) return lobe.mean;
        const float d = 1.0f + lobe.g * lobe.g - 2.0f * lobe.g * glm::dot(lobe.axis, direction);
        return (1.0f - lobe.g * lobe.g) / (d * std::sqrt(d)) * lobe.mean;
    }
    /// Over all directions [W/sr].
    const core::Rgb& mean_intensity(std::uint32_t node) const { return lobes_[node].mean; }

  private:
    struct Lobe {
        core::Rgb mean;   ///< over directions [W/sr]
        core::Vec3 axis;  ///< unit
        float g;          ///< in [0, 1)
    };
    std::vector<Lobe> lobes_;
};

}  // namespace mote::gathering
