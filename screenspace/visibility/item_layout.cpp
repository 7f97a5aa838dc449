#include "screenspace/visibility/item_layout.h"

#include <fmt/format.h>

#include <stdexcept>

#include "screenspace/visibility/id_picture.h"

namespace mote::screenspace {

ItemLayout::ItemLayout(std::span<const std::uint32_t> instances, int t) : t_(t), first_item_{0} {
    if (t < 0 || t > 12) throw std::invalid_argument(fmt::format("2^{} tiles a side: t must be 0 to 12", t));
    std::uint64_t items = 0;
    for (const std::uint32_t count : instances) {
        items += count;
        // The largest number of 32 bits means no item.
        if ((items << (2 * t)) > no_item)
            throw std::length_error(
                fmt::format("{} instances in {} tiles do not fit into IDs of 32 bits", items, tiles()));
        first_item_.push_back(std::uint32_t(items));
    }
}

ItemLayout ItemLayout::of_objects(std::uint32_t objects, int t) {
    if ((std::uint64_t(objects) << (2 * std::max(t, 0))) > no_item)
        throw std::length_error(fmt::format("{} objects do not fit into IDs of 32 bits", objects));
    return ItemLayout(std::vector<std::uint32_t>(objects, 1), t);
}

std::uint32_t ItemLayout::item(std::uint32_t object, std::uint32_t instance) const {
    if (object >= objects() || instance >= first_item_[object + 1] - first_item_[object])
        throw std::out_of_range(fmt::format("no instance {} of object {}", instance, object));
    return first_item_[object] + instance;
}

}  // namespace mote::screenspace
