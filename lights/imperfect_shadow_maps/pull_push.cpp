// Fills holes in a map of points. Pull-push: means of known texels go up to coarser levels, and come down
// to where nothing is. Then gaps, through which a texel sees something behind.
#include "lights/imperfect_shadow_maps/imperfect_shadow_maps.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int max_levels = 3;   // holes up to 2^3 texels wide
constexpr float behind = 1.3f;  // so much nearer are others than what a gap shows
constexpr int majority_of_eight = 5;

/// The mean of up to four texels, if half of those that there are are known.
float pulled(std::span<const float> fine, int size, int x, int y) {
    float sum = 0.0f;
    int known = 0, all = 0;
    for (int j = 2 * y; j < std::min(2 * y + 2, size); ++j)
        for (int i = 2 * x; i < std::min(2 * x + 2, size); ++i) {
            const float value = fine[std::size_t(j * size + i)];
            ++all, sum += value, known += value > 0.0f;
        }
    return 2 * known >= all ? sum / float(known) : 0.0f;
}

void pull_push(std::span<float> map, int size, int levels) {
    if (levels == 0 || size < 2) return;
    const int half = (size + 1) / 2;
    std::vector<float> coarse(std::size_t(half) * std::size_t(half));
    for (int y = 0; y < half; ++y)
        for (int x = 0; x < half; ++x) coarse[std::size_t(y * half + x)] = pulled(map, size, x, y);
    pull_push(coarse, half, levels - 1);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (float& value = map[std::size_t(y * size + x)]; value == 0.0f)
                value = coarse[std::size_t(y / 2 * half + x / 2)];
}

}  // namespace

void pull_push(std::span<float> map, int size) { pull_push(map, size, max_levels); }

void close_gaps(std::span<float> map, const ShadowMapView& view) {
    const std::vector<float> open(map.begin(), map.end());
    for (int texel = 0; texel < view.texels(); ++texel) {
        const int column = texel % view.size, row = texel / view.size;
        float sum = 0.0f;
        int nearer = 0;
        for (int j = row - 1; j <= row + 1; ++j)
            for (int i = column - 1; i <= column + 1; ++i) {
                const float value = open[std::size_t(view.neighbour(i, j))];
                if (value > behind * open[std::size_t(texel)]) sum += value, ++nearer;
            }
        if (nearer >= majority_of_eight) map[std::size_t(texel)] = sum / float(nearer);
    }
}

}  // namespace mote::lights
