#include "core/math/sampler.h"

namespace mote::core {
namespace {

std::uint32_t reverse_bits(std::uint32_t v) {
    v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
    v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
    v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
    v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
    return (v >> 16) | (v << 16);
}

/// A hash in which bit i of the result depends on bits 0..i only (Laine & Karras 2011, constants of Vegdahl
/// 2021).
std::uint32_t laine_karras_permutation(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

/// Owen scrambling of the bits of v from the most significant down.
std::uint32_t nested_uniform_scramble(std::uint32_t v, std::uint32_t seed) {
    return reverse_bits(laine_karras_permutation(reverse_bits(v), seed));
}

/// The second dimension of the Sobol sequence: its direction numbers are the rows of Pascal's triangle mod 2.
std::uint32_t sobol_second_dimension(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t v = 1u << 31; index != 0; index >>= 1, v ^= v >> 1)
        if (index & 1u) result ^= v;
    return result;
}

}  // namespace

Vec2 Sampler::sobol(std::uint32_t dimension) const {
    const std::uint64_t h = hash_keys(key_, dimension, 0x736f626full);
    const auto shuffle_seed = std::uint32_t(h);
    const auto scramble_seed = std::uint32_t(h >> 32);
    // Shuffling the index keeps the pairs of dimensions independent of each other: it permutes the order of
    // the points within every power-of-two block, which Owen scrambling of the (bit-reversed) index does
    // exactly.
    const std::uint32_t index = nested_uniform_scramble(pass_, shuffle_seed);
    const std::uint32_t x = nested_uniform_scramble(reverse_bits(index), scramble_seed);
    const std::uint32_t y =
        nested_uniform_scramble(sobol_second_dimension(index), scramble_seed ^ 0x5bd1e995u);
    return {to_unit_float(x), to_unit_float(y)};
}

}  // namespace mote::core
