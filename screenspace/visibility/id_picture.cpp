#include "screenspace/visibility/id_picture.h"

#include <fmt/format.h>

#include <stdexcept>

namespace mote::screenspace {

void check(const IdPicture& picture) {
    const bool sizes = picture.width >= 0 && picture.height >= 0;
    if (!sizes || picture.items.size() != std::size_t(picture.width) * std::size_t(picture.height))
        throw std::invalid_argument(fmt::format("a picture of {} x {} pixels has {} items", picture.width,
                                                picture.height, picture.items.size()));
}

void refuse_item(std::uint32_t item, int x, int y, std::uint32_t items) {
    throw std::out_of_range(
        fmt::format("pixel ({}, {}) shows item {}, but there are only {}", x, y, item, items));
}

}  // namespace mote::screenspace
