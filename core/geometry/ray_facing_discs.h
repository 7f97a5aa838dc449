// Many discs that turn to face every ray: a ray meets a disc when it passes its centre nearer than its
// radius, at the distance where it passes nearest. On Embree, which has them as a primitive.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/math/ray.h"

namespace mote::core {

class RayFacingDiscs {
  public:
    /// Centre and radius [m]; radii must be positive.
    struct Disc {
        Vec3 center;
        float radius;
    };
    struct Hit {
        float t;              ///< along the ray, where it passes the centre nearest
        std::uint32_t index;  ///< of the disc
    };
    RayFacingDiscs();
    ~RayFacingDiscs();
    RayFacingDiscs(RayFacingDiscs&&) noexcept;
    RayFacingDiscs& operator=(RayFacingDiscs&&) noexcept;

    /// Replaces all discs; keeps the vector's memory as its own.
    void build(std::vector<Disc> discs);
    std::span<const Disc> discs() const;

    /// Every disc met within (t_min, t_max), by distance, equal ones by index. Clears `hits` first.
    void hits(const Ray& ray, std::vector<Hit>& hits) const;

    std::size_t memory_bytes() const;  ///< discs and Embree's structures

  private:
    struct Implementation;
    std::unique_ptr<Implementation> impl_;
};

}  // namespace mote::core
