// Packed numbers come back to the bit, take no more than they must, and lying heads are refused.
#include "core/image/packed_numbers.h"

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
        using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
        REQUIRE(std::bit_cast<Bits>(back[i]) == std::bit_cast<Bits>(numbers[i]));
    }
    return packing.size;
}

}  // namespace

TEST_CASE("Packed numbers are the same bits again", "[film][packed]") {
    Rng rng(1);
    for (const std::size_t count : {0u, 1u, 255u, 256u, 257u, 5000u}) {
        const std::size_t groups = (count + 255) / 256;
        std::vector<double> numbers(count, 0.0);
        CHECK(there_and_back(numbers) == groups);
        for (double& x : numbers) x = double(rng.next_float());  // 24 of 53 bits: three bytes are empty
        CHECK(there_and_back(numbers) <= groups + 5 * count);
        for (double& x : numbers)
            x = std::bit_cast<double>(std::uint64_t(rng.next_u32()) << 32 |
                                      rng.next_u32());  // NaN and infinity as well
        there_and_back(numbers);
        std::vector<float> singles(count, -0.0f);
        CHECK(there_and_back(singles) == groups + count);
        for (float& x : singles) x = rng.next_float() - 0.5f;
        there_and_back(singles);
    }
}

TEST_CASE("Heads of packed numbers that cannot be are refused", "[film][packed]") {
    const std::vector<double> numbers(300, 1.0 / 3.0);
    const Packing packing = packing_of(std::span<const double>(numbers));
    std::vector<std::byte> bytes(packing.size);
    pack(std::span<const double>(numbers), packing, bytes.data());
    CHECK(read_packing(bytes, 300, 8));
    CHECK_FALSE(read_packing(std::span(bytes).first(bytes.size() - 1), 300, 8));
    CHECK_FALSE(read_packing(std::span(bytes).first(1), 300, 8));
    bytes[1] = std::byte(9);
    CHECK_FALSE(read_packing(bytes, 300, 8));
}
