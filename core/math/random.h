// Random numbers that depend on keys and never on threads: integer hashes and the PCG32 generator.
#pragma once

#include <cstdint>

#include "core/math/vec.h"

namespace mote::core {

/// Mixes all bits of a 64-bit key (the finaliser of MurmurHash3 as improved by Stafford, "Mix13").
inline std::uint64_t mix_bits(std::uint64_t v) {
    v ^= v >> 30, v *= 0xbf58476d1ce4e5b9ull;
    v ^= v >> 27, v *= 0x94d049bb133111ebull;
    return v ^ (v >> 31);
}
/// A hash and one more key.
inline std::uint64_t hash_combine(std::uint64_t h, std::uint64_t v) {
    return mix_bits(h + 0x9e3779b97f4a7c15ull + mix_bits(v + 0x632be59bd9b4e019ull));
}
/// Hash of any number of keys, in order.
template <typename... Keys>
std::uint64_t hash_keys(std::uint64_t first, Keys... rest) {
    std::uint64_t h = mix_bits(first + 0x9e3779b97f4a7c15ull);
    ((h = hash_combine(h, std::uint64_t(rest))), ...);
    return h;
}

/// 32 random bits as a float in [0, 1): the upper 24 bits, so that 1 is never reached.
inline float to_unit_float(std::uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }

/// PCG32 (O'Neill 2014): the stream of numbers behind tracking, where no fixed number of dimensions suffices.
class Rng {
  public:
    Rng() : Rng(0) {}
    /// Generators of different keys are independent.
    explicit Rng(std::uint64_t key) : state_(0), increment_((mix_bits(key) << 1) | 1u) {
        next_u32();
        state_ += mix_bits(key ^ 0x853c49e6748fea9bull);
        next_u32();
    }
    /// 32 random bits.
    std::uint32_t next_u32() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ull + increment_;
        const auto xorshifted = std::uint32_t(((old >> 18) ^ old) >> 27);
        const auto rot = std::uint32_t(old >> 59);
        return (xorshifted >> rot) | (xorshifted << ((32u - rot) & 31u));
    }
    /// Uniform in [0, 1).
    float next_float() { return to_unit_float(next_u32()); }
    /// Uniform in [0, 1)^2.
    Vec2 next_vec2() {
        const float x = next_float();
        return {x, next_float()};
    }

  private:
    std::uint64_t state_, increment_;
};

}  // namespace mote::core
