#include "core/film/pass_blocks.h"

#include <algorithm>
#include <cmath>

#include "core/film/for_each_pixel.h"

namespace mote::core {

std::uint32_t PassBlocks::Range::blocks(std::size_t k) const {
    const std::uint64_t before = (std::uint64_t(first) + (1ull << (k + 1)) - 1) >> (k + 1);
    const std::uint64_t end = std::uint64_t(first + count) >> (k + 1);
    return std::uint32_t(end - std::min(before, end));
}

std::vector<double> PassBlocks::differences(std::span<const double> weights, double unit,
                                            const Range& passes) const {
    std::vector<double> d;
    for (std::size_t k = 0; passes.blocks(k) > 0; ++k) {
        double squares = 0.0;
        for (std::size_t p = 0; p < pixels_; ++p) squares += weights[p] * half_squares_[k].at(p);
        d.push_back(squares / (unit * unit) / passes.blocks(k) / std::exp2(double(k) + 2.0));
    }
    return d;
}

PassBlocks::Range PassBlocks::add(const PassBlocks& more, Range passes) {
    while (half_squares_.size() < more.half_squares_.size()) half_squares_.emplace_back(pixels_);
    for (std::size_t k = 0; k < more.half_squares_.size(); ++k)
        for_each_pixel(pixels_, [&](std::size_t p) { half_squares_[k].add(p, more.half_squares_[k]); });
    for (const Block& of_more : more.blocks_) {
        if (of_more.level > largest_)
            largest_ = of_more.level, largest_difference_ = more.largest_difference_;
        Next block(*this, passes.first + passes.count, of_more.level);
        for_each_pixel(pixels_, [&](std::size_t p) { block.put(p, of_more.sums[p]); });
        block.finish();
        passes.count += 1u << of_more.level;
    }
    return passes;
}

PassBlocks::Next::Next(PassBlocks& all, std::uint32_t first, std::uint32_t level) : all_(all), level_(level) {
    std::vector<Block>& blocks = all_.blocks_;
    for (; joins_ < blocks.size(); ++joins_) {
        const Block& before = blocks[blocks.size() - 1 - joins_];
        if (before.level != level + joins_ || (before.first >> before.level) % 2 == 1) break;
    }
    if (all_.keeps_ == Keeps::all)
        while (all_.half_squares_.size() < level + joins_) all_.half_squares_.emplace_back(all_.pixels_);
    grows_ = joins_ > 0 && level + joins_ > all_.largest_;
    if (grows_ && all_.keeps_ == Keeps::largest) all_.largest_difference_.resize(all_.pixels_);
    if (joins_ == 0) blocks.push_back({first, level, std::vector<float>(all_.pixels_)});
    target_ = blocks.size() - std::max<std::size_t>(joins_, 1);
}

void PassBlocks::Next::finish() {
    all_.blocks_[target_].level = level_ + std::uint32_t(joins_);
    all_.blocks_.resize(target_ + 1);
    all_.largest_ = std::max(all_.largest_, all_.blocks_[target_].level);
}

}  // namespace mote::core
