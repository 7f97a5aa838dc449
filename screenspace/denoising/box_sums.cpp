#include "screenspace/denoising/box_sums.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace mote::screenspace {

namespace {

/// A window is summed anew in every pixel: running sums would carry rounding of bright pixels along.
void sum_rows(int width, int height, std::span<const float> from, std::span<float> to, int radius) {
    tbb::parallel_for(0, height, [&](int y) {
        const float* row = from.data() + std::size_t(y) * std::size_t(width);
        float* result = to.data() + std::size_t(y) * std::size_t(width);
        for (int x = 0; x < width; ++x) {
            float sum = 0.0f;
            for (int i = std::max(0, x - radius); i <= std::min(width - 1, x + radius); ++i) sum += row[i];
            result[x] = sum;
        }
    });
}

void sum_columns(int width, int height, std::span<const float> from, std::span<float> to, int radius) {
    tbb::parallel_for(0, height, [&](int y) {
        float* result = to.data() + std::size_t(y) * std::size_t(width);
        std::fill(result, result + width, 0.0f);
        for (int j = std::max(0, y - radius); j <= std::min(height - 1, y + radius); ++j) {
            const float* row = from.data() + std::size_t(j) * std::size_t(width);
            for (int x = 0; x < width; ++x) result[x] += row[x];
        }
    });
}

}  // namespace

std::vector<float> box_sums(int width, int height, std::span<const float> values, int radius) {
    std::vector<float> rows(values.size()), result(values.size());
    sum_rows(width, height, values, rows, radius);
    sum_columns(width, height, rows, result, radius);
    return result;
}

}  // namespace mote::screenspace
