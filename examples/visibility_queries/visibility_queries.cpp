// Granular visibility queries: how many pixels of an item lie in a rectangle of a picture of item numbers,
// from sums over the picture (never fewer than there are) and exactly. Two thousand discs before a plane,
// nearer ones in front.
#include <mote/core/math/random.h>
#include <mote/screenspace/visibility/exact_counts.h>
#include <mote/screenspace/visibility/region_queries.h>

#include <cstdio>
#include <vector>

using namespace mote;
namespace ss = screenspace;

constexpr int width = 512, height = 384;

int main() {
    core::Rng rng(1);
    std::vector<std::uint32_t> items(width * height, ss::no_item);  // the plane is no item
    std::vector<ss::ItemBounds> bounds;
    for (std::uint32_t item = 0; item < 2000; ++item) {
        const float x = width * rng.next_float(), y = height * rng.next_float(),
                    r = 1.0f + 8.0f * rng.next_float();
        for (int py = 0; py < height; ++py)
            for (int px = 0; px < width; ++px) {
                const float dx = float(px) + 0.5f - x, dy = float(py) + 0.5f - y;
                if (dx * dx + dy * dy < r * r) items[std::size_t(py * width + px)] = item;
            }
        const float along_diagonals = 1.4142136f * r;
        bounds.push_back(ss::bounds_of_outline(x, y, r, r, along_diagonals, along_diagonals));
    }
    const ss::IdPicture picture{width, height, items};
    const ss::RegionQueries sums(picture, bounds, {.channels = 8});
    const ss::ExactCounts exact(picture, std::uint32_t(bounds.size()));

    int below = 0, equal = 0, above = 0;
    for (std::uint32_t item = 0; item < bounds.size(); ++item) {
        const ss::VisibilityQuery query{item, {width / 4, 0, width, height / 2}};
        const std::uint32_t a = sums.pixels(query), b = exact.pixels(query);
        below += a<b, equal += a == b, above += a> b;
    }
    std::printf("%zu items in %zu regions: %d counts are exact, %d too large, %d too small\n", bounds.size(),
                sums.sets().regions(), equal, above, below);
    return below == 0 && equal > above ? 0 : 1;
}
