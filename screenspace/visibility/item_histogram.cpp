#include "screenspace/visibility/item_histogram.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace mote::screenspace {

namespace {

/// Where tile i of n begins, of so many pixels: the first c with floor(c n / pixels) = i.
int tile_begin(int i, int n, int pixels) { return int((std::int64_t(i) * pixels + n - 1) / n); }

/// Bands of rows that are counted apart, at least: more than cores, so that they share the work evenly.
constexpr int min_bands = 16;

}  // namespace

ItemHistogram::ItemHistogram(const IdPicture& picture, const ItemLayout& layout)
    : layout_(layout), width_(picture.width), height_(picture.height) {
    check(picture);
    for (int l = 0; l <= layout.t(); ++l)
        levels_.emplace_back(std::size_t(layout.items()) << (2 * (layout.t() - l)));
    if (!picture.items.empty()) count(picture);
    make_levels();
}

/// Bins of different rows of tiles are different, so a task that has a row of tiles to itself writes to the
/// histogram. Where there are few of those, each is cut into bands with bins of their own, which are added
/// up.
void ItemHistogram::count(const IdPicture& picture) {
    const int side = layout_.side(), t = layout_.t();
    const std::size_t bins = std::size_t(layout_.items()) << t;  // of one row of tiles
    // Copies of more bins than there are pixels would cost more than they save.
    const int cuts = bins <= picture.items.size() ? std::max(1, min_bands / side) : 1;
    std::vector<std::uint32_t>& all = levels_.front();
    tbb::parallel_for(0, side, [&](int ty) {
        const int top = tile_begin(ty, side, height_), rows = tile_begin(ty + 1, side, height_) - top;
        const auto count_rows = [&](int y0, int y1, std::uint32_t* first, int row_shift, std::size_t offset) {
            for (int y = y0; y < y1; ++y)
                for (int tx = 0; tx < side; ++tx)
                    for_each_run(picture.row(y), tile_begin(tx, side, width_),
                                 tile_begin(tx + 1, side, width_),
                                 [&](std::uint32_t item, int begin, int end) {
                                     if (item >= layout_.items())
                                         refuse_item(item, begin, y, layout_.items());
                                     first[(std::size_t(item) << row_shift) + offset + std::size_t(tx)] +=
                                         std::uint32_t(end - begin);
                                 });
        };
        if (cuts == 1) return count_rows(top, top + rows, all.data(), 2 * t, std::size_t(ty) << t);
        const std::vector<std::uint32_t> none(bins);
        std::vector<std::vector<std::uint32_t>> bands(static_cast<std::size_t>(cuts), none);
        tbb::parallel_for(0, cuts, [&](int b) {
            count_rows(top + rows * b / cuts, top + rows * (b + 1) / cuts, bands[std::size_t(b)].data(), t,
                       0);
        });
        for (const auto& band : bands)
            for (std::size_t bin = 0; bin < bins; ++bin) {
                const std::size_t item = bin >> t, x = bin & (std::size_t(side) - 1);
                all[(item << (2 * t)) + (std::size_t(ty) << t) + x] += band[bin];
            }
    });
}

void ItemHistogram::make_levels() {
    using Items = tbb::blocked_range<std::size_t>;
    for (int l = 1; l <= layout_.t(); ++l) {
        const auto& below = levels_[std::size_t(l) - 1];
        auto& level = levels_[std::size_t(l)];
        const std::size_t side = std::size_t(1) << (layout_.t() - l);
        tbb::parallel_for(Items(0, layout_.items(), 256), [&](const Items& items) {
            // An item's rows of tiles follow each other, and so do the items: pairs of rows below, one row
            // here.
            for (std::size_t row = items.begin() * side; row < items.end() * side; ++row) {
                const std::uint32_t* upper = &below[4 * row * side];
                const std::uint32_t* lower = upper + 2 * side;
                for (std::size_t x = 0; x < side; ++x)
                    level[row * side + x] = upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1];
            }
        });
    }
}

PixelRectangle ItemHistogram::tile(int x, int y) const {
    const int side = layout_.side();
    return {tile_begin(x, side, width_), tile_begin(y, side, height_), tile_begin(x + 1, side, width_),
            tile_begin(y + 1, side, height_)};
}

std::uint32_t ItemHistogram::pixels_around(std::uint32_t item, const PixelRectangle& rectangle) const {
    const PixelRectangle r = intersection(rectangle, {0, 0, width_, height_});
    if (r.empty()) return 0;
    const auto tile_of = [&](int c, int pixels) { return int(std::int64_t(c) * layout_.side() / pixels); };
    std::uint32_t sum = 0;
    for (int y = tile_of(r.y0, height_); y <= tile_of(r.y1 - 1, height_); ++y)
        for (int x = tile_of(r.x0, width_); x <= tile_of(r.x1 - 1, width_); ++x) sum += pixels(item, 0, x, y);
    return sum;
}

}  // namespace mote::screenspace
