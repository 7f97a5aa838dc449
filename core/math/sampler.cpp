#include "core/math/sampler.h"

namespace mote::core {
namespace {

std::uint32_t reverse_bits(std::uint32_t v) {
    v = __builtin_bswap32(v);
    v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
    v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
    return ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
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

/// Bit-reversed second dimension of the Sobol sequence. Its generator matrix is Pascal's triangle mod 2,
/// where C(i, j) is odd exactly if the bits of j are a subset of those of i (Lucas): five steps of a subset
/// sum.
std::uint32_t pascal_matrix_times(std::uint32_t v) {
    v ^= (v >> 1) & 0x55555555u;
    v ^= (v >> 2) & 0x33333333u;
    v ^= (v >> 4) & 0x0f0f0f0fu;
    v ^= (v >> 8) & 0x00ff00ffu;
    return v ^ (v >> 16);
}

}  // namespace

void Sampler::make_sobol(std::uint32_t first) {
    for (std::uint32_t i = 0; i < block; ++i) {
        const std::uint64_t h = mix_bits(key_ + 0x9e3779b97f4a7c15ull * (first + i + 1ull));
        const auto shuffle_seed = std::uint32_t(h);
        const auto scramble_seed = std::uint32_t(h >> 32);
        // Nested uniform scrambling is reverse, permute, reverse. Shuffling the index by it keeps the pairs
        // of dimensions independent of each other: it permutes the points within every power-of-two block of
        // passes.
        const std::uint32_t index = reverse_bits(laine_karras_permutation(reverse_bits(pass_), shuffle_seed));
        // Both dimensions are reversed indices, and reversing twice is nothing: one reversal remains of each.
        const std::uint32_t x = reverse_bits(laine_karras_permutation(index, scramble_seed));
        const std::uint32_t y =
            reverse_bits(laine_karras_permutation(pascal_matrix_times(index), scramble_seed ^ 0x5bd1e995u));
        x_[i] = to_unit_float(x), y_[i] = to_unit_float(y);
    }
}

}  // namespace mote::core
