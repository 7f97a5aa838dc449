// Gradient noise in three dimensions, and sums of its octaves: what stirs the source of the smoke and shapes
// the cloud. Perlin 2002 ("Improving noise"), with gradients from a hash of seed and lattice point.
#pragma once

#include <cstdint>

#include "core/math/vec.h"

namespace mote::tools {

class Noise {
  public:
    explicit Noise(std::uint64_t seed) : seed_(seed) {}

    /// One octave in about [-1, 1], with mean 0 and features of size 1.
    float at(const core::Vec3& p) const;
    /// `octaves` octaves, each of half the size and `gain` times the height of the one before.
    float fractal(const core::Vec3& p, int octaves, float gain = 0.5f) const;
    /// Like fractal(), of absolute values: round bulges with creases between them, in about [0, 1].
    float billow(const core::Vec3& p, int octaves, float gain = 0.5f) const;
    /// Three independent octaves: a vector in about [-1, 1]^3.
    core::Vec3 vector_at(const core::Vec3& p) const;

  private:
    float gradient(int x, int y, int z, const core::Vec3& offset) const;

    std::uint64_t seed_;
};

}  // namespace mote::tools
