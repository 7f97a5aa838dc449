#include "screenspace/visibility/exact_counts.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <stdexcept>
#include <utility>

namespace mote::screenspace {

namespace {
constexpr int max_bands = 16;  // of rows, that are read side by side
}

ExactCounts::ExactCounts(const IdPicture& picture, std::uint32_t items) : first_(items + std::size_t(1)) {
    check(picture);
    const int bands = items <= picture.items.size() ? std::clamp(picture.height / 32, 1, max_bands) : 1;
    const auto for_each_row_of = [&](int band, const auto& visit) {
        for (int y = picture.height * band / bands; y < picture.height * (band + 1) / bands; ++y)
            for_each_run(picture.row(y), 0, picture.width, [&](std::uint32_t item, int x0, int x1) {
                visit(item, Run{y, x0, x1});
            });
    };
    // How many runs of each item a band has, then where they go.
    const std::vector<std::size_t> none(items);
    std::vector<std::vector<std::size_t>> positions(static_cast<std::size_t>(bands), none);
    tbb::parallel_for(0, bands, [&](int band) {
        auto& counts = positions[std::size_t(band)];
        for_each_row_of(band, [&](std::uint32_t item, const Run& run) {
            if (item >= items) refuse_item(item, run.x0, run.y, items);
            ++counts[item];
        });
    });
    std::size_t next = 0;
    for (std::uint32_t item = 0; item < items; ++item) {
        first_[item] = next;
        for (auto& position : positions) next += std::exchange(position[item], next);
    }
    first_[items] = next;
    runs_.resize(next);
    tbb::parallel_for(0, bands, [&](int band) {
        auto& position = positions[std::size_t(band)];
        for_each_row_of(band, [&](std::uint32_t item, const Run& run) { runs_[position[item]++] = run; });
    });
    pixels_.resize(items);
    for (std::uint32_t item = 0; item < items; ++item)
        for (std::size_t i = first_[item]; i < first_[item + 1]; ++i)
            pixels_[item] += std::uint32_t(runs_[i].x1 - runs_[i].x0);
}

std::uint32_t ExactCounts::pixels(const VisibilityQuery& query) const {
    if (query.item >= items())
        throw std::out_of_range(fmt::format("item {}, but there are only {}", query.item, items()));
    const PixelRectangle& r = query.rectangle;
    const auto end = runs_.begin() + std::ptrdiff_t(first_[query.item + 1]);
    auto run = std::partition_point(runs_.begin() + std::ptrdiff_t(first_[query.item]), end,
                                    [&](const Run& candidate) { return candidate.y < r.y0; });
    std::uint32_t sum = 0;
    for (; run != end && run->y < r.y1; ++run)
        sum += std::uint32_t(std::max(0, std::min(run->x1, r.x1) - std::max(run->x0, r.x0)));
    return sum;
}

PixelRectangle ExactCounts::bounds(std::uint32_t item) const {
    if (pixels_[item] == 0) return {};
    const std::size_t first = first_[item], end = first_[item + 1];
    PixelRectangle r{runs_[first].x0, runs_[first].y, runs_[first].x1, runs_[end - 1].y + 1};
    for (std::size_t i = first; i < end; ++i)
        r.x0 = std::min(r.x0, runs_[i].x0), r.x1 = std::max(r.x1, runs_[i].x1);
    return r;
}

}  // namespace mote::screenspace
