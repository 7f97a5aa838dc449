#include "screenspace/visibility/region_queries.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <stdexcept>

namespace mote::screenspace {

namespace {

[[noreturn]] void refuse_pixel(std::uint32_t item, int x, int y) {
    throw std::invalid_argument(
        fmt::format("pixel ({}, {}) shows item {}, but lies outside of its bounds", x, y, item));
}

/// Calls pixels(begin, end, channel) for the parts of a run that lie in the channels from `first` on; returns
/// how many pixels of it lie in any region.
template <typename Pixels>
int paint_run(std::span<const Region> regions, int y, int x0, int x1, int first, const Pixels& pixels) {
    int covered = 0;
    for (const Region& region : regions) {
        const PixelRectangle& r = region.rectangle;
        const int begin = std::max(x0, r.x0), end = std::min(x1, r.x1);
        if (y < r.y0 || y >= r.y1 || begin >= end) continue;
        covered += end - begin;
        if (const int c = int(region.channel) - first; c >= 0 && c < ChannelSums::channels)
            pixels(begin, end, c);
    }
    return covered;
}

}  // namespace

RegionQueries::RegionQueries(const IdPicture& picture, std::span<const ItemBounds> bounds,
                             const RegionSettings& settings)
    : frame_(picture.frame()), sets_(bounds, (check(picture), picture.frame()), settings) {
    for (int c = 0; c < settings.channels; c += ChannelSums::channels)
        sums_.emplace_back(picture.width, picture.height);
    paint(picture);
}

void RegionQueries::paint(const IdPicture& picture) {
    for (std::size_t table = 0; table < sums_.size(); ++table) {
        ChannelSums& sums = sums_[table];
        const int first = int(table) * ChannelSums::channels;
        tbb::parallel_for(0, sums.bands(), [&](int band) {
            sums.fill_band(band, [&](int y, const auto& pixels) {
                for_each_run(picture.row(y), 0, picture.width, [&](std::uint32_t item, int x0, int x1) {
                    if (item >= sets_.size()) refuse_item(item, x0, y, std::uint32_t(sets_.size()));
                    if (paint_run(sets_.of(item), y, x0, x1, first, pixels) != x1 - x0)
                        refuse_pixel(item, x0, y);
                });
            });
        });
        sums.finish();
    }
}

std::uint32_t RegionQueries::pixels(std::uint32_t item) const { return pixels({item, frame_}); }

std::uint32_t RegionQueries::pixels(const VisibilityQuery& query) const {
    std::uint32_t sum = 0;
    for (const Region& region : sets_.of(query.item)) {
        // S and R_i in Sec. 6.1.4.
        const PixelRectangle both = intersection(intersection(query.rectangle, region.rectangle), frame_);
        if (!both.empty())
            sum += sums_[region.channel / ChannelSums::channels].pixels(
                both, region.channel % ChannelSums::channels);
    }
    return sum;
}

}  // namespace mote::screenspace
