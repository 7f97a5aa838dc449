// A part of a ray that lies in one medium, as light scatters along it: what both a ray light and an eye ray
// are.
//
// The part is cut into equal cells. A medium that varies is walked once: at the ends of the cells stand
// estimates of the transmittance from the beginning, each the product of independent ones, so that the
// transmittance to any point is the product of the last of them and a short estimate, without bias. The
// weight of a cell is what light scatters in it, about: sigma_s T. It steers distances (line_sampling.h), and
// is above 0 wherever light could scatter.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/shape.h"
#include "core/scene/medium.h"
#include "core/scene/medium_state.h"
#include "lights/ray_lights/line_sampling.h"

namespace mote::lights {

/// Properties of a medium that lines need, found once.
struct MediumKind {
    const core::Medium* medium;             ///< not null
    bool homogeneous, isotropic;            ///< the same coefficients everywhere; an isotropic phase function
    core::MediumCoefficients coefficients;  ///< of a homogeneous medium
    float voxel_size;                       ///< of others [m]
    core::Bounds3 bounds;                   ///< of others
};

/// The media of a scene that scatter light.
class ScatteringMedia {
  public:
    /// `media`: all media of a scene, such as RayQueries::media(); they must outlive this.
    explicit ScatteringMedia(std::span<const std::shared_ptr<core::Medium>> media);
    /// Null where the medium does not scatter, or is null.
    const MediumKind* find(const core::Medium* medium) const {
        for (const MediumKind& kind : kinds_)
            if (kind.medium == medium) return &kind;
        return nullptr;
    }

  private:
    std::vector<MediumKind> kinds_;
};

/// Number of cells of a line through a medium of voxels [m].
std::uint32_t count_cells(float length, float voxel);

/// A segment of a ray within one medium.
struct MediumLine {
    core::Vec3 origin{0.0f}, direction{0, 0, 1};  ///< unit direction
    float length = 0.0f;                          ///< [m]
    const core::Medium* medium = nullptr;         ///< null: no line
    core::Rgb sigma_t{0.0f};                 ///< of a homogeneous medium, else the mean of its lookups [1/m]
    core::Rgb sigma_s{0.0f};                 ///< likewise [1/m]
    bool homogeneous = false;                ///< sigma_t is exact
    bool isotropic = true;                   ///< the phase function is 1 / (4 pi)
    std::uint32_t cells = 1;                 ///< at most max_cells
    std::array<float, max_cells> weights{};  ///< of cells
    std::array<core::Rgb, max_cells + 1> transmittance;  ///< to the ends of cells; not of homogeneous media

    /// Weights of the cells that the line has.
    std::span<const float> cell_weights() const { return std::span(weights).first(cells); }
    core::Vec3d at(double t) const { return core::Vec3d(origin) + t * core::Vec3d(direction); }  ///< [m]
    /// Cell of a distance.
    std::size_t cell_of(double t) const;
    /// Estimate of T(t) sigma_s(t) [1/m].
    core::Rgb scattering(double t, core::Rng& rng, core::TrackingCounters& counters) const;
    /// Phase function [1/sr] for light that goes along the line and on towards `to`, or comes from `to` and
    /// goes back along the line; the same number. `to` is unit length.
    core::Rgb phase(const core::Vec3& to) const;
};

/// The part [t0, t1] of a ray in a medium; t1 may be infinite. In homogeneous media the line ends
/// at an optical depth of 40, where no light is left in single precision; in others where the medium does.
/// Nothing where that leaves no line.
std::optional<MediumLine> make_medium_line(const core::Ray& ray, float t0, float t1, const MediumKind& kind,
                                           core::Rng& rng, core::TrackingCounters& counters);

/// A ray up to a distance, with the media at ray.t_min and the boundaries on the way, sorted by distance.
struct RayThroughMedia {
    const core::Ray& ray;                          ///< unit direction
    float t_end;                                   ///< [m]
    const core::MediumState& state;                ///< at ray.t_min
    std::span<const core::SurfaceHit> boundaries;  ///< before t_end, nearest first
};

/// Calls visit(line, state, transmittance) for all parts of a ray in media that scatter: `state` holds the
/// media there, `transmittance` is an estimate from ray.t_min to the beginning of the part.
template <typename Visit>
void for_each_medium_line(const RayThroughMedia& through, const ScatteringMedia& media, core::Rng& rng,
                          core::TrackingCounters& counters, const Visit& visit);

}  // namespace mote::lights

#include "lights/ray_lights/medium_line_impl.h"
