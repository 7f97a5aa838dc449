// The beams of all light subpaths of a pass, in a hierarchy of boxes for query beams that cross them.
//
// A beam is long and thin, and the box of a slanted one is mostly empty: each is cut into pieces with a box
// of their own. A crossing, where two lines come nearest to each other, belongs to one of them.
#pragma once

#include <memory>
#include <optional>

#include "core/geometry/box_hierarchy.h"
#include "integrators/bidirectional/beam.h"
#include "integrators/bidirectional/light_ends.h"

namespace mote::integrators {

struct LightBeam {
    std::uint32_t path = 0;  ///< index of the subpath
    LightPoint start;        ///< of that
    Beam beam;
};

/// Where two lines come nearest to each other.
struct Crossing {
    double t = 0.0, s = 0.0;  ///< distances along them [m]
    double apart = 0.0;       ///< [m]
    double sine = 0.0;        ///< of the angle between them
};
/// Nothing where they are parallel.
std::optional<Crossing> crossing_of(const core::Ray& query, const core::Ray& beam);

class LightBeams {
  public:
    struct Hit {
        float t = 0.0f, s = 0.0f;  ///< along the query and the light's beam [m]
        float sine = 0.0f;         ///< of the angle between them
        std::uint32_t beam = 0;
    };
    LightBeams() = default;
    /// Keeps references. `radius` of the kernel [m], above 0. `size` of the scene [m]: boxes are
    /// a 24th of it long, or longer. It has those that MergeSettings::sampled() leaves.
    LightBeams(const std::vector<Subpath>& paths, const std::vector<std::vector<LightBeam>>& rows,
               const MergeSettings& merging, double size, core::Rng rng);

    /// All beams that the ray passes nearer than the radius, by t; equal ones by index. Clears `hits` first.
    /// Returns how many pieces were tested.
    std::size_t crossings(const core::Ray& ray, std::vector<Hit>& hits) const;
    const LightBeam& beam(const Hit& hit) const { return *beams_[hit.beam]; }
    const Subpath& path(const LightBeam& beam) const { return (*paths_)[beam.path]; }
    std::size_t size() const { return beams_.size(); }

    static constexpr int max_pieces = 24;  ///< of one beam
    /// What a beam takes in all structures [B], with as many pieces as most have.
    static double bytes_of(const LightBeam& b) {
        constexpr double piece = double(sizeof(Piece) + sizeof(core::Bounds3) + 128), pieces = 4.0;
        return double(sizeof(LightBeam) + sizeof(const LightBeam*)) + pieces * piece +
               double(b.beam.boundaries.capacity() * sizeof(core::SurfaceHit));
    }

  private:
    struct Piece {
        std::uint32_t beam;
        float first, last;  ///< distances along it: [first, last)
    };
    void cut(std::uint32_t index, const Beam& beam, float end, float length);
    void cut_part(std::uint32_t beam, const core::Ray& part, float length);

    const std::vector<Subpath>* paths_ = nullptr;
    double radius_ = 0.0;
    std::vector<const LightBeam*> beams_;
    std::vector<Piece> pieces_;
    std::vector<core::Bounds3> boxes_;  ///< read by the hierarchy
    std::unique_ptr<core::BoxHierarchy> hierarchy_;
};

}  // namespace mote::integrators
