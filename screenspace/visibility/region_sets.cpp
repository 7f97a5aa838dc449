#include "screenspace/visibility/region_sets.h"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>
#include <utility>

#include "screenspace/visibility/conflict_graph.h"

namespace mote::screenspace {

namespace {

/// A part of a conflict item, and the channels that others have somewhere in it.
struct Part {
    PixelRectangle rectangle;
    std::uint32_t taken = 0;
};

struct Other {
    PixelRectangle rectangle;
    std::uint8_t channel;
    const ItemBounds* bounds;
};

/// Splits the rectangle of one conflict item (Fig. 6.3).
class Splitting {
  public:
    Splitting(const ItemBounds& own, const PixelRectangle& whole, const RegionSettings& settings)
        : own_(own), settings_(settings), all_((1u << settings.channels) - 1), parts_{{whole}} {}

    void add(const Other& other) {
        others_.push_back(other);
        const std::uint32_t bit = 1u << other.channel;
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const PixelRectangle both = intersection(parts_[i].rectangle, other.rectangle);
            if (both.empty() || (parts_[i].taken & bit)) continue;
            const bool mine = own_.meets(both), theirs = other.bounds->meets(both);
            if (!mine && !theirs) continue;  // an empty overlap
            if (both == parts_[i].rectangle) {
                parts_[i].taken |= bit;
            } else if (int(parts_.size()) + 4 <= settings_.max_rectangles) {
                split(i, both, mine, bit);
            } else {
                parts_[i].taken |= bit;
            }
        }
    }

    /// Pairs of parts that share an edge and still have a free channel in common become one.
    void merge() {
        for (bool again = true; again;) {
            again = false;
            for (std::size_t i = 0; i < parts_.size(); ++i)
                for (std::size_t j = i + 1; j < parts_.size();)
                    if ((parts_[i].taken | parts_[j].taken) != all_ && join(parts_[i], parts_[j])) {
                        parts_[j] = parts_.back(), parts_.pop_back();
                        again = true;
                    } else {
                        ++j;
                    }
        }
    }

    /// Appends the regions; returns how many of them share their channel.
    std::size_t finish(std::vector<Region>& regions) const {
        std::size_t shared = 0;
        for (const Part& part : parts_) {
            if (!own_.meets(part.rectangle)) continue;
            const std::uint32_t free = all_ & ~part.taken;
            const int channel = free ? std::countr_zero(free) : channel_of_fewest_conflicts(part.rectangle);
            regions.push_back({part.rectangle, std::uint8_t(channel)});
            shared += free == 0;
        }
        return shared;
    }

  private:
    /// Cuts `both` out of a part. It stays as a part of its own where the item can be seen there.
    void split(std::size_t i, const PixelRectangle& both, bool mine, std::uint32_t bit) {
        const Part part = parts_[i];
        const PixelRectangle& r = part.rectangle;
        const std::array<PixelRectangle, 4> rest{{{r.x0, r.y0, r.x1, both.y0},
                                                  {r.x0, both.y1, r.x1, r.y1},
                                                  {r.x0, both.y0, both.x0, both.y1},
                                                  {both.x1, both.y0, r.x1, both.y1}}};
        parts_[i] = {mine ? both : PixelRectangle{}, part.taken | bit};
        for (const PixelRectangle& piece : rest)
            if (own_.meets(piece)) parts_.push_back({piece, part.taken});
    }

    static bool join(Part& a, const Part& b) {
        PixelRectangle& r = a.rectangle;
        const PixelRectangle& s = b.rectangle;
        const bool rows = r.y0 == s.y0 && r.y1 == s.y1 && (r.x1 == s.x0 || s.x1 == r.x0);
        const bool columns = r.x0 == s.x0 && r.x1 == s.x1 && (r.y1 == s.y0 || s.y1 == r.y0);
        if (!rows && !columns) return false;
        r = {std::min(r.x0, s.x0), std::min(r.y0, s.y0), std::max(r.x1, s.x1), std::max(r.y1, s.y1)};
        a.taken |= b.taken;
        return true;
    }

    /// The channel whose other rectangles cover least of `r`, counted for each of both that may be seen
    /// there.
    int channel_of_fewest_conflicts(const PixelRectangle& r) const {
        std::array<std::int64_t, 32> area{};
        for (const Other& other : others_) {
            const PixelRectangle both = intersection(r, other.rectangle);
            area[other.channel] += both.area() * (int(own_.meets(both)) + int(other.bounds->meets(both)));
        }
        return int(std::min_element(area.begin(), area.begin() + settings_.channels) - area.begin());
    }

    const ItemBounds& own_;
    const RegionSettings& settings_;
    std::uint32_t all_;
    std::vector<Part> parts_;
    std::vector<Other> others_;
};

}  // namespace

RegionSets::RegionSets(std::span<const ItemBounds> bounds, const PixelRectangle& frame,
                       const RegionSettings& settings)
    : channels_(settings.channels), sets_(bounds.size()) {
    if (settings.channels < 1 || settings.channels > 16 || settings.max_rectangles < 1)
        throw std::invalid_argument("region sets have 1 to 16 channels, and at least one rectangle an item");
    std::vector<PixelRectangle> rectangles;
    for (const ItemBounds& b : bounds) rectangles.push_back(intersection(b.rectangle, frame));
    const ConflictGraph graph(rectangles);
    const std::vector<std::int8_t> channel = colour(graph, settings.channels);
    for (std::size_t i = 0; i < bounds.size(); ++i)
        if (channel[i] != conflict && !rectangles[i].empty()) {
            sets_[i] = {regions_.size(), 1};
            regions_.push_back({rectangles[i], std::uint8_t(channel[i])});
        }
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        if (channel[i] != conflict || rectangles[i].empty()) continue;
        Splitting splitting(bounds[i], rectangles[i], settings);
        for (const std::uint32_t n : graph.neighbours(i))
            for (const Region& region : of(n))
                if (overlap(region.rectangle, rectangles[i]))
                    splitting.add({region.rectangle, region.channel, &bounds[n]});
        splitting.merge();
        sets_[i].first = regions_.size();
        shared_ += splitting.finish(regions_);
        sets_[i].count = regions_.size() - sets_[i].first;
        std::sort(regions_.begin() + std::ptrdiff_t(sets_[i].first), regions_.end(),
                  [](const Region& a, const Region& b) {
                      return std::pair(a.rectangle.x0, a.rectangle.y0) <
                             std::pair(b.rectangle.x0, b.rectangle.y0);
                  });
        ++conflicts_;
    }
}

}  // namespace mote::screenspace
