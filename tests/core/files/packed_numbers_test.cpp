// Packed numbers come back to the bit, take no more than they must, and lying heads are refused.
#include "core/files/packed_numbers.h"

#include <array>
#include <bit>
#include <limits>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

template <typename T>
std::size_t there_and_back(const std::vector<T>& numbers) {
    const Packing packing = packing_of(std::span(numbers));
    std::vector<std::byte> bytes(packing.size);
    pack(std::span(numbers), packing, bytes.data());
    const auto read = read_packing(bytes, numbers.size(), sizeof(T));
    REQUIRE(read);
    CHECK(read->size == packing.size);
    std::vector<T> back(numbers.size(), T(7));
    unpack(bytes.data(), *read, std::span(back));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto bytes_of = [](const T& x) { return std::bit_cast<std::array<std::byte, sizeof(T)>>(x); };
        REQUIRE(bytes_of(back[i]) == bytes_of(numbers[i]));
    }
    return packing.size;
}

}  // namespace

TEST_CASE("Packed numbers are the same bits again", "[film][packed]") {
    Rng rng(1);
    for (const std::size_t count : {0u, 1u, 255u, 256u, 257u, 5000u}) {
        const std::size_t groups = (count + 255) / 256;
        std::vector<std::int64_t> numbers(count, 0);
        CHECK(there_and_back(numbers) == groups);
        for (std::int64_t& x : numbers) x = (std::int64_t(rng.next_u32() >> 9) - (1 << 22)) * (1 << 16);
        CHECK(there_and_back(numbers) <= groups + 3 * count);  // 23 bits and two empty bytes below them
        for (std::int64_t& x : numbers) x = rng.next_u32() % 2 == 0 ? 127 : -128;
        CHECK(there_and_back(numbers) == groups + count);
        for (std::int64_t& x : numbers)
            x = std::int64_t(std::uint64_t(rng.next_u32()) << 32 | rng.next_u32());
        there_and_back(numbers);
        for (std::int64_t& x : numbers)
            x = std::numeric_limits<std::int64_t>::min() + std::int64_t(rng.next_u32() % 2);
        there_and_back(numbers);
        std::vector<std::uint8_t> small(count, 26);
        CHECK(there_and_back(small) == groups + count);
        std::vector<float> singles(count, -0.0f);
        CHECK(there_and_back(singles) == groups + count);
        for (float& x : singles) x = rng.next_float() - 0.5f;
        there_and_back(singles);
    }
}

TEST_CASE("Heads of packed numbers that cannot be are refused", "[film][packed]") {
    const std::vector<float> numbers(300, 1.0f / 3.0f);
    const Packing packing = packing_of(std::span<const float>(numbers));
    std::vector<std::byte> bytes(packing.size);
    pack(std::span<const float>(numbers), packing, bytes.data());
    CHECK(read_packing(bytes, 300, 4));
    CHECK_FALSE(read_packing(std::span(bytes).first(bytes.size() - 1), 300, 4));
    CHECK_FALSE(read_packing(std::span(bytes).first(1), 300, 4));
    bytes[1] = std::byte(0x23) /* 3 bytes kept, 2 below them */;
    CHECK_FALSE(read_packing(bytes, 300, 4));
}
