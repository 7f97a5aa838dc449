// The numbering of hierarchical item buffers (Engelhardt 2013, Sec. 6.2): every instance of every object in
// every tile of the screen has a bin of its own, whose number is
//   ID = base + instance 4^t + x + y 2^t,   x, y in [0, 2^t)
// With base = 4^t times the instances of the objects before, the IDs of all objects together have no gap.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace mote::screenspace {

class ItemLayout {
  public:
    /// `instances` of each object, and a screen of 2^t x 2^t tiles. Throws std::invalid_argument unless t is
    /// in [0, 12], and std::length_error where the IDs do not fit into 32 bits.
    ItemLayout(std::span<const std::uint32_t> instances, int t);
    /// Objects of one instance each.
    static ItemLayout of_objects(std::uint32_t objects, int t);

    int t() const { return t_; }
    int side() const { return 1 << t_; }                        ///< 2^t
    std::uint32_t tiles() const { return 1u << (2 * t_); }      ///< 4^t
    std::uint32_t items() const { return first_item_.back(); }  ///< instances of all objects
    std::uint64_t bins() const { return std::uint64_t(items()) << (2 * t_); }
    std::uint32_t objects() const { return std::uint32_t(first_item_.size() - 1); }

    /// Number in a picture where it shows this instance: (base + instance 4^t) / 4^t. Throws
    /// std::out_of_range where there is no such instance.
    std::uint32_t item(std::uint32_t object, std::uint32_t instance) const;
    std::uint32_t base(std::uint32_t object) const { return first_item_[object] << (2 * t_); }
    /// The bin of an item in a tile, both of which must exist.
    std::uint32_t id(std::uint32_t item, int x, int y) const {
        return (item << (2 * t_)) + std::uint32_t(x) + (std::uint32_t(y) << t_);
    }

  private:
    int t_;
    std::vector<std::uint32_t> first_item_;  ///< of each object; the last one is their number
};

}  // namespace mote::screenspace
