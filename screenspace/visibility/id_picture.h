// Input of granular visibility queries: a picture of item numbers, one a pixel, and rectangles of pixels
// (Engelhardt 2013, Ch. 6).
//
// An *item* is an object, one of its instances, or any part of it that is queried. The picture is that of a
// camera or of a light.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mote::screenspace {

/// Pixel that shows no item.
inline constexpr std::uint32_t no_item = 0xffffffffu;

/// Pixels x0 <= x < x1 and y0 <= y < y1; none where an end is not above its beginning.
struct PixelRectangle {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< ends

    /// No pixel.
    bool empty() const { return x1 <= x0 || y1 <= y0; }
    /// Pixels.
    std::int64_t area() const { return empty() ? 0 : std::int64_t(x1 - x0) * (y1 - y0); }
    bool operator==(const PixelRectangle&) const = default;  ///< same ends
};

/// Pixels of both.
inline PixelRectangle intersection(const PixelRectangle& a, const PixelRectangle& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}
/// True where they share a pixel.
inline bool overlap(const PixelRectangle& a, const PixelRectangle& b) { return !intersection(a, b).empty(); }

/// Items row by row from the top. May be empty.
struct IdPicture {
    int width = 0, height = 0;             ///< [pixels]
    std::span<const std::uint32_t> items;  ///< by pixel

    /// First item of a row.
    const std::uint32_t* row(int y) const { return items.data() + std::size_t(y) * std::size_t(width); }
    /// All pixels.
    PixelRectangle frame() const { return {0, 0, width, height}; }
};

/// Throws std::invalid_argument unless there is one number a pixel.
void check(const IdPicture& picture);
/// Throws std::out_of_range with the item, the pixel and the number of items.
[[noreturn]] void refuse_item(std::uint32_t item, int x, int y, std::uint32_t items);

/// Calls visit(item, begin, end) for every run of pixels [begin, end) of [x0, x1) that show the same item;
/// pixels that show none are left out.
template <typename Visit>
void for_each_run(const std::uint32_t* row, int x0, int x1, const Visit& visit) {
    for (int x = x0; x < x1;) {
        const std::uint32_t item = row[x];
        const int begin = x;
        do ++x;
        while (x < x1 && row[x] == item);
        if (item != no_item) visit(item, begin, x);
    }
}

}  // namespace mote::screenspace
