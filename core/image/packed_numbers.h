// Arrays of float or double as fewer bytes: low bytes that are zero in all of 256 neighbours are left out.
//
// Sums of a few passes are doubles whose last bits are empty, and whole rows of a picture may be black. A
// checkpoint that is written when somebody pressed Ctrl-C has about half the bytes for it. Layout: for each
// group of 256 numbers how many high bytes are kept (0 to 4 or 8), then those of all numbers in order,
// little-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace mote::core {

struct Packing {
    std::vector<std::uint8_t> kept;   ///< bytes of each number, for every group
    std::vector<std::size_t> offset;  ///< where a group begins, behind `kept`
    std::size_t size = 0;             ///< bytes of all
};

template <typename T>
Packing packing_of(std::span<const T> numbers);
/// `to`: packing.size bytes.
template <typename T>
void pack(std::span<const T> numbers, const Packing& packing, std::byte* to);

/// What the first bytes say of `count` numbers of `number_size` bytes; nothing where that cannot be.
std::optional<Packing> read_packing(std::span<const std::byte> from, std::size_t count,
                                    std::size_t number_size);
/// `from`: as many bytes as the packing has.
template <typename T>
void unpack(const std::byte* from, const Packing& packing, std::span<T> to);

}  // namespace mote::core
