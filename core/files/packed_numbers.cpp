// Groups are independent of each other, so all threads take part.
#include "core/files/packed_numbers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

namespace mote::core {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t group_size = 256;

template <typename T>
using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t,
                                std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint8_t>>;

/// The bits that matter: of a whole number those above which all are as the sign.
template <typename T>
Bits<T> telling(T x) {
    const auto bits = std::bit_cast<Bits<T>>(x);
    if constexpr (std::is_same_v<T, std::int64_t>)  // one more for the sign itself
        return (bits ^ Bits<T>(x >> 63)) << 1 | (bits & 1);
    else
        return bits;
}

constexpr std::size_t kept(std::uint8_t head) { return head & 15u; }
constexpr std::size_t skipped(std::uint8_t head) { return head >> 4; }

std::size_t groups_of(std::size_t count) { return (count + group_size - 1) / group_size; }

/// Offsets and size from the heads.
void lay_out(Packing& packing, std::size_t count) {
    std::size_t at = packing.heads.size();
    for (std::size_t g = 0; g < packing.heads.size(); ++g) {
        packing.offset.push_back(at);
        at += kept(packing.heads[g]) * std::min(group_size, count - g * group_size);
    }
    packing.size = at;
}

/// Calls body(first, numbers, head, offset) for every group.
template <typename Body>
void for_each_group(const Packing& packing, std::size_t count, const Body& body) {
    tbb::parallel_for(std::size_t(0), packing.heads.size(), [&](std::size_t g) {
        const std::size_t first = g * group_size;
        body(first, std::min(group_size, count - first), packing.heads[g], packing.offset[g]);
    });
}

/// body(std::integral_constant<kept>): loops over bytes of a known number are several times faster.
template <std::size_t most, typename Body>
void with_constant(std::size_t bytes, const Body& body) {
    if constexpr (most > 0) {
        if (bytes == most)
            body(std::integral_constant<std::size_t, most>());
        else
            with_constant<most - 1>(bytes, body);
    }
}

}  // namespace

template <typename T>
Packing packing_of(std::span<const T> numbers) {
    Packing packing;
    packing.heads.resize(groups_of(numbers.size()));
    tbb::parallel_for(std::size_t(0), packing.heads.size(), [&](std::size_t g) {
        const std::size_t first = g * group_size;
        Bits<T> any = 0, telling_any = 0;
        for (const T& x : numbers.subspan(first, std::min(group_size, numbers.size() - first)))
            any |= std::bit_cast<Bits<T>>(x), telling_any |= telling(x);
        if (any == 0) return;
        const std::size_t below = std::size_t(std::countr_zero(any)) / 8;
        // Floats have their sign and exponent at the top.
        const std::size_t end =
            std::is_integral_v<T> ? std::size_t(std::bit_width(telling_any) + 7) / 8 : sizeof(T);
        packing.heads[g] = std::uint8_t((std::max(end, below + 1) - below) | below << 4);
    });
    lay_out(packing, numbers.size());
    return packing;
}

template <typename T>
void pack(std::span<const T> numbers, const Packing& packing, std::byte* to) {
    std::copy_n(reinterpret_cast<const std::byte*>(packing.heads.data()), packing.heads.size(), to);
    for_each_group(packing, numbers.size(),
                   [&](std::size_t first, std::size_t count, std::uint8_t head, std::size_t offset) {
                       with_constant<sizeof(T)>(kept(head), [&](auto bytes) {
                           for (std::size_t i = 0; i < count; ++i) {
                               const auto from =
                                   Bits<T>(std::bit_cast<Bits<T>>(numbers[first + i]) >> 8 * skipped(head));
                               std::memcpy(to + offset + i * bytes, &from, bytes);
                           }
                       });
                   });
}

std::optional<Packing> read_packing(std::span<const std::byte> from, std::size_t count,
                                    std::size_t number_size) {
    const std::size_t groups = groups_of(count);
    if (from.size() < groups) return std::nullopt;
    Packing packing;
    packing.heads.resize(groups);
    std::copy_n(from.begin(), groups, reinterpret_cast<std::byte*>(packing.heads.data()));
    if (std::any_of(packing.heads.begin(), packing.heads.end(),
                    [&](auto head) { return kept(head) + skipped(head) > number_size; }))
        return std::nullopt;
    lay_out(packing, count);
    return packing.size <= from.size() ? std::optional(std::move(packing)) : std::nullopt;
}

template <typename T>
void unpack(const std::byte* from, const Packing& packing, std::span<T> to) {
    for_each_group(packing, to.size(),
                   [&](std::size_t first, std::size_t count, std::uint8_t head, std::size_t offset) {
                       if (kept(head) == 0) std::fill_n(to.begin() + std::ptrdiff_t(first), count, T(0));
                       with_constant<sizeof(T)>(kept(head), [&](auto bytes) {
                           constexpr std::size_t above = 8 * (sizeof(T) - bytes);
                           for (std::size_t i = 0; i < count; ++i) {
                               Bits<T> bits = 0;
                               std::memcpy(&bits, from + offset + i * bytes, bytes);
                               if constexpr (std::is_same_v<T, std::int64_t>)  // the sign is extended upwards
                                   bits = Bits<T>(T(bits << above) >> above);
                               to[first + i] = std::bit_cast<T>(Bits<T>(bits << 8 * skipped(head)));
                           }
                       });
                   });
}

template Packing packing_of(std::span<const float>);
template Packing packing_of(std::span<const std::int64_t>);
template Packing packing_of(std::span<const std::uint8_t>);
template void pack(std::span<const float>, const Packing&, std::byte*);
template void pack(std::span<const std::int64_t>, const Packing&, std::byte*);
template void pack(std::span<const std::uint8_t>, const Packing&, std::byte*);
template void unpack(const std::byte*, const Packing&, std::span<float>);
template void unpack(const std::byte*, const Packing&, std::span<std::int64_t>);
template void unpack(const std::byte*, const Packing&, std::span<std::uint8_t>);

}  // namespace mote::core
