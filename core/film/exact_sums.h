// Sums that do not depend on the order of their terms, so that films may be added up in any way.
//
// Floating-point addition rounds, and rounds differently in another order. Here a number is cut at fixed
// powers of two into digits of 40 bits, and digits of one place are added as integers, which is exact (binned
// summation: Demmel and Nguyen 2015). Of all places a sum keeps the highest that any of its terms has reached
// and the one below. What lies lower is cut off term by term: at most 2^-40 of the largest term, of every
// term the same in every order, towards zero. A float has 24 bits, so it loses nothing beside terms of its
// own size.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace mote::core {

class ExactSums {
  public:
    /// So many terms fit into a sum: digits below 2^40 in 63 bits.
    static constexpr std::uint32_t max_terms = (1u << 23) - 1;

    explicit ExactSums(std::size_t size = 0) : high_(size, 0), low_(size, 0), place_(size, 0) {}
    std::size_t size() const { return place_.size(); }
    bool empty() const { return place_.empty(); }

    /// Adds a finite number to sum i. Below 2^-1022 it is taken for zero.
    void add(std::size_t i, double term) {
        const auto bits = std::bit_cast<std::uint64_t>(term);
        const auto exponent = std::uint32_t(bits >> 52) & 0x7ffu;
        if (exponent == 0) return;
        // The leading bit is number `rest` of the digit at `place`, the other 52 follow.
        const std::uint32_t place = (exponent + digit - 1) / digit, rest = (exponent + digit - 1) % digit;
        const std::uint64_t mantissa = (bits & ((1ull << 52) - 1)) | (1ull << 52);
        const std::uint64_t below = mantissa & ((1ull << (52 - rest)) - 1);
        auto high = std::int64_t(mantissa >> (52 - rest));
        auto low = std::int64_t(rest >= 12 ? below << (rest - 12) : below >> (12 - rest));
        if (std::int64_t(bits) < 0) high = -high, low = -low;
        add_digits(i, place, high, low);
    }
    /// True where any term was not zero.
    bool any() const {
        return std::any_of(place_.begin(), place_.end(), [](std::uint8_t place) { return place > 0; });
    }
    /// Adds sums of as many numbers: the same as adding all their terms.
    void add(std::size_t i, const ExactSums& other) {
        if (other.place_[i] > 0) add_digits(i, other.place_[i], other.high_[i], other.low_[i]);
    }
    /// Rounded to double: a function of the exact sum alone.
    double at(std::size_t i) const {
        return (double(high_[i]) * 0x1p40 + double(low_[i])) * unit_of_low[place_[i]];
    }

    /// All that there is to write and to read again: body(numbers) for each of three arrays.
    template <typename Sums, typename Body>
    static void for_each_array(Sums& sums, const Body& body) {
        body(sums.place_), body(sums.high_), body(sums.low_);
    }
    /// True where at() is defined everywhere: sums that were read may be damaged.
    bool places_exist() const {
        for (const std::uint8_t place : place_)
            if (place >= unit_of_low.size()) return false;
        return true;
    }

  private:
    static constexpr std::uint32_t digit = 40;  ///< bits of one

    /// 2^(40 place - 1102), the weight of the lower digit, for all places of a double.
    static constexpr std::array<double, 53> unit_of_low = [] {
        std::array<double, 53> units{};
        units[1] = 0x1p-1062;
        for (std::size_t i = 2; i < units.size(); ++i) units[i] = units[i - 1] * 0x1p40;
        return units;
    }();

    void add_digits(std::size_t i, std::uint32_t place, std::int64_t high, std::int64_t low) {
        const std::uint32_t highest = place_[i];
        if (place == highest) {
            high_[i] += high, low_[i] += low;
        } else if (place + 1 == highest) {
            low_[i] += high;
        } else if (place > highest) {
            low_[i] = low + (place == highest + 1 ? high_[i] : 0);
            high_[i] = high, place_[i] = std::uint8_t(place);
        }
    }

    std::vector<std::int64_t> high_, low_;  ///< digits at place_ and below it
    std::vector<std::uint8_t> place_;       ///< 0: no term but zeros yet
};

}  // namespace mote::core
