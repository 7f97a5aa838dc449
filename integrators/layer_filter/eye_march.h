// Transmittance of the media along an eye ray, and their scattering towards the eye, without noise:
//   T(t) per channel,   S(t) = int_0^t T sigma_s dt',
// marched once a pixel and evaluated at the surface of every sample, whose rays run so close that they share
// it.
#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "screenspace/in_scattering/in_scattering.h"

namespace mote::integrators {

class EyeMarch {
  public:
    struct Value {
        core::Rgb transmittance{1.0f}, scattering{0.0f};
    };

    /// Up to ray.t_max, which may be infinity; evaluated at distances up to `last`, and at ray.t_max. Grids
    /// in steps of `voxels` voxels. Panes are not counted.
    void march(const core::Scene& scene, const core::Ray& ray, float last, float voxels,
               core::WalkContext& walk);
    /// At the distance t, linear between steps.
    Value at(float t) const;

  private:
    struct Knot {
        float t;
        Value value;
    };
    void add_part(const core::Medium& medium, const core::Ray& part, float voxels, core::WalkContext& walk);

    std::vector<Knot> knots_;
    std::vector<screenspace::MediumSegment> segments_;
    std::vector<core::Vec3d> depths_;
};

}  // namespace mote::integrators
