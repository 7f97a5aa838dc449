// Groups are independent of each other, so all threads take part.
#include "core/image/packed_numbers.h"

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
using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;

std::size_t groups_of(std::size_t count) { return (count + group_size - 1) / group_size; }

/// Offsets and size from what is kept.
void lay_out(Packing& packing, std::size_t count) {
    std::size_t at = packing.kept.size();
    for (std::size_t g = 0; g < packing.kept.size(); ++g) {
        packing.offset.push_back(at);
        at += packing.kept[g] * std::min(group_size, count - g * group_size);
    }
    packing.size = at;
}

/// Calls body(first, numbers, kept, offset) for every group.
template <typename Body>
void for_each_group(const Packing& packing, std::size_t count, const Body& body) {
    tbb::parallel_for(std::size_t(0), packing.kept.size(), [&](std::size_t g) {
        const std::size_t first = g * group_size;
        body(first, std::min(group_size, count - first), packing.kept[g], packing.offset[g]);
    });
}

/// body(std::integral_constant<kept>): loops over bytes of a known number are several times faster.
template <std::size_t most, typename Body>
void with_constant(std::size_t kept, const Body& body) {
    if constexpr (most > 0) {
        if (kept == most)
            body(std::integral_constant<std::size_t, most>());
        else
            with_constant<most - 1>(kept, body);
    }
}

}  // namespace

template <typename T>
Packing packing_of(std::span<const T> numbers) {
    Packing packing;
    packing.kept.resize(groups_of(numbers.size()));
    tbb::parallel_for(std::size_t(0), packing.kept.size(), [&](std::size_t g) {
        const std::size_t first = g * group_size;
        Bits<T> any = 0;
        for (const T& x : numbers.subspan(first, std::min(group_size, numbers.size() - first)))
            any |= std::bit_cast<Bits<T>>(x);
        packing.kept[g] = std::uint8_t(any == 0 ? 0 : sizeof(T) - std::size_t(std::countr_zero(any)) / 8);
    });
    lay_out(packing, numbers.size());
    return packing;
}

template <typename T>
void pack(std::span<const T> numbers, const Packing& packing, std::byte* to) {
    std::copy_n(reinterpret_cast<const std::byte*>(packing.kept.data()), packing.kept.size(), to);
    for_each_group(packing, numbers.size(),
                   [&](std::size_t first, std::size_t count, std::size_t kept, std::size_t offset) {
                       with_constant<sizeof(T)>(kept, [&](auto bytes) {
                           for (std::size_t i = 0; i < count; ++i) {
                               const auto high =
                                   std::bit_cast<Bits<T>>(numbers[first + i]) >> (8 * (sizeof(T) - bytes));
                               std::memcpy(to + offset + i * bytes, &high, bytes);
                           }
                       });
                   });
}

std::optional<Packing> read_packing(std::span<const std::byte> from, std::size_t count,
                                    std::size_t number_size) {
    const std::size_t groups = groups_of(count);
    if (from.size() < groups) return std::nullopt;
    Packing packing;
    packing.kept.resize(groups);
    std::copy_n(from.begin(), groups, reinterpret_cast<std::byte*>(packing.kept.data()));
    if (std::any_of(packing.kept.begin(), packing.kept.end(), [&](auto kept) { return kept > number_size; }))
        return std::nullopt;
    lay_out(packing, count);
    return packing.size <= from.size() ? std::optional(std::move(packing)) : std::nullopt;
}

template <typename T>
void unpack(const std::byte* from, const Packing& packing, std::span<T> to) {
    for_each_group(packing, to.size(),
                   [&](std::size_t first, std::size_t count, std::size_t kept, std::size_t offset) {
                       if (kept == 0) std::fill_n(to.begin() + std::ptrdiff_t(first), count, T(0));
                       with_constant<sizeof(T)>(kept, [&](auto bytes) {
                           for (std::size_t i = 0; i < count; ++i) {
                               Bits<T> high = 0;
                               std::memcpy(&high, from + offset + i * bytes, bytes);
                               to[first + i] = std::bit_cast<T>(Bits<T>(high << (8 * (sizeof(T) - bytes))));
                           }
                       });
                   });
}

template Packing packing_of(std::span<const float>);
template Packing packing_of(std::span<const double>);
template void pack(std::span<const float>, const Packing&, std::byte*);
template void pack(std::span<const double>, const Packing&, std::byte*);
template void unpack(const std::byte*, const Packing&, std::span<float>);
template void unpack(const std::byte*, const Packing&, std::span<double>);

}  // namespace mote::core
