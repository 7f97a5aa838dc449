// A 64-bit checksum for files of our own, and for telling whether the inputs of a render have changed.
//
// FNV-1a over 64-bit words instead of bytes (eight times faster on films of a gigabyte). Every step is a
// bijection of the state, so a change within a single word always changes the result. It finds accidents; it
// is no defence against forged files.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

#include "core/math/random.h"

namespace mote::core {

inline constexpr std::uint64_t checksum_start = 0xcbf29ce484222325ull;

/// Continues `h` with bytes and their number, so that "ab" + "c" differs from "a" + "bc".
inline std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t h = checksum_start) {
    constexpr std::uint64_t prime = 0x100000001b3ull;
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        std::uint64_t word;
        std::memcpy(&word, bytes.data() + i, 8);
        // The rotation lets high bits reach low ones, which multiplication alone never does.
        h = (h ^ word) * prime;
        h = (h << 29) | (h >> 35);
    }
    std::uint64_t rest = 0;
    if (i < bytes.size()) std::memcpy(&rest, bytes.data() + i, bytes.size() - i);
    h = (h ^ rest) * prime;
    return mix_bits(h ^ std::uint64_t(bytes.size()) * 0x9e3779b97f4a7c15ull);
}

}  // namespace mote::core
