// Sums over blocks of passes, pixel by pixel, and how the halves of blocks differ: what sobol_gain.h needs.
//
// Passes are put together to the largest aligned blocks of 2^k, as a binary counter carries: a block whose
// other half has come is one with it. Every time the square of their difference is added to a sum; or that
// of the largest block so far is kept alone, which takes less memory.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/film/exact_sums.h"

namespace mote::core {

class PassBlocks {
  public:
    enum class Keeps : std::uint8_t { all, largest };
    /// `pixels` 0: keeps nothing.
    explicit PassBlocks(std::size_t pixels = 0, Keeps keeps = Keeps::all) : pixels_(pixels), keeps_(keeps) {}
    std::size_t pixels() const { return pixels_; }
    /// Squares of the difference of the halves of the largest block, 2^level passes, the first of several, by
    /// pixel. Empty for level 0. Needs Keeps::largest.
    std::span<const float> largest_difference() const { return largest_difference_; }
    std::uint32_t largest_level() const { return largest_; }

    /// Passes from `first` on.
    struct Range {
        std::uint32_t first = 0, count = 0;
        /// Number of complete aligned blocks of 2^(k+1) passes.
        std::uint32_t blocks(std::size_t k) const;
    };
    /// d[k] of sobol_gain.h, the sum over pixels times their weights, for the passes of the blocks.
    /// `unit`: of light. Needs Keeps::all.
    std::vector<double> differences(std::span<const double> weights, double unit, const Range& passes) const;

    class Next;
    /// Adds the blocks that follow the passes. Returns the passes of both.
    Range add(const PassBlocks& more, Range passes);

    /// Lets it have the arrays of so many passes, with zeros. `allow` is called with the number of values
    /// before each is allocated.
    template <typename Allow>
    void allocate(const Range& passes, const Allow& allow);
    /// All that there is to write and to read again: body(numbers) for each array.
    template <typename Blocks, typename Body>
    static void for_each_array(Blocks& blocks, const Body& body) {
        for (auto& block : blocks.blocks_) body(block.sums);
        for (auto& sums : blocks.half_squares_) ExactSums::for_each_array(sums, body);
        if (!blocks.largest_difference_.empty()) body(blocks.largest_difference_);
    }
    std::span<const ExactSums> half_squares() const { return half_squares_; }

  private:
    /// 2^level passes from `first` on, a multiple of that.
    struct Block {
        std::uint32_t first = 0, level = 0;
        std::vector<float> sums;
    };
    /// Calls body(first, level) for the largest aligned blocks that passes consist of, in order.
    template <typename Body>
    static void for_each_block(const Range& passes, const Body& body);

    std::size_t pixels_;
    Keeps keeps_;
    std::uint32_t largest_ = 0;  ///< level of the largest block so far
    std::vector<float> largest_difference_;
    std::vector<Block> blocks_;            ///< the largest that the passes consist of, in order
    std::vector<ExactSums> half_squares_;  ///< [k]: how the halves of blocks of 2^(k+1) differ, squared
};

/// A block behind those that there are.
class PassBlocks::Next {
  public:
    /// Block of 2^level passes from `first` on.
    Next(PassBlocks& all, std::uint32_t first, std::uint32_t level = 0);
    /// Its sum of a pixel. Once a pixel, in any order, from any thread.
    void put(std::size_t pixel, float sum) {
        for (std::size_t k = 0; k < joins_; ++k) {
            const float before = all_.blocks_[all_.blocks_.size() - 1 - k].sums[pixel];
            const double difference = double(before) - double(sum);
            if (all_.keeps_ == Keeps::all)
                all_.half_squares_[level_ + k].add(pixel, difference * difference);
            else if (grows_ && k + 1 == joins_)
                all_.largest_difference_[pixel] = float(difference * difference);
            sum += before;
        }
        all_.blocks_[target_].sums[pixel] = sum;
    }
    /// After all pixels.
    void finish();

  private:
    PassBlocks& all_;
    std::uint32_t level_;
    std::size_t joins_ = 0, target_ = 0;
    bool grows_ = false;  ///< it becomes the largest
};

template <typename Body>
void PassBlocks::for_each_block(const Range& passes, const Body& body) {
    std::uint64_t first = passes.first;
    for (const std::uint64_t end = first + passes.count; first < end;) {
        const auto fits = std::uint32_t(std::bit_width(end - first) - 1);
        const std::uint32_t level =
            first == 0 ? fits : std::min(fits, std::uint32_t(std::countr_zero(first)));
        body(std::uint32_t(first), level);
        first += 1ull << level;
    }
}

template <typename Allow>
void PassBlocks::allocate(const Range& passes, const Allow& allow) {
    if (pixels_ == 0) return;
    for_each_block(passes, [&](std::uint32_t first, std::uint32_t level) {
        allow(pixels_);
        blocks_.push_back({first, level, std::vector<float>(pixels_)});
        largest_ = std::max(largest_, level);
    });
    if (keeps_ == Keeps::largest) {
        if (largest_ > 0) allow(pixels_), largest_difference_.resize(pixels_);
        return;
    }
    while (passes.blocks(half_squares_.size()) > 0) {
        allow(3 * pixels_);
        half_squares_.emplace_back(pixels_);
    }
}

}  // namespace mote::core
