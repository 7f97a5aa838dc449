// Arrays of numbers as fewer bytes: bytes that are redundant in all of 256 neighbours are left out.
//
// Low bytes are zero where sums are those of a few floats, or rows of a picture are black; high bytes of
// small whole numbers repeat the sign. A checkpoint that is written after an interruption has about
// half the bytes for it. Layout: for each group of 256 numbers one byte, how many bytes of each are kept (0
// to 8) plus 16 times how many zero bytes there were below them; then the kept bytes of all numbers in order,
// little-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace mote::core {

struct Packing {
    std::vector<std::uint8_t> heads;  ///< of each group, as in the file
    std::vector<std::size_t> offset;  ///< where a group begins, behind `heads`
    std::size_t size = 0;             ///< bytes of all
};

/// T: float, std::int64_t or std::uint8_t.
template <typename T>
Packing packing_of(std::span<const T> numbers);
/// `to`: packing.size bytes.
template <typename T>
void pack(std::span<const T> numbers, const Packing& packing, std::byte* to);

/// Lower bound of the packed size of `count` numbers of any size [B]; unpacked they have at most 2048 times
/// as many bytes.
constexpr std::uint64_t min_packed_size(std::uint64_t count) { return (count + 255) / 256; }
/// Packing of `count` numbers of `number_size` bytes, from the heads that `from` begins with; nothing where
/// the heads are invalid or `from` is too short.
std::optional<Packing> read_packing(std::span<const std::byte> from, std::size_t count,
                                    std::size_t number_size);
/// `from`: as many bytes as the packing has.
template <typename T>
void unpack(const std::byte* from, const Packing& packing, std::span<T> to);

}  // namespace mote::core
