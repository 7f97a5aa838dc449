#include "screenspace/denoising/block_regression.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "core/math/random.h"
#include "screenspace/denoising/feature_block.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// A grid of blocks over the picture, and the weight of its fits in a pixel.
struct BlockGrid {
    int block, x0, y0, columns, rows;

    BlockGrid(int width, int height, int block_side, Vec2i offset) : block(block_side) {
        const auto begin = [&](int at) {
            const int inside = ((at % block) + block) % block;
            return inside > 0 ? inside - block : 0;
        };
        x0 = begin(offset.x), y0 = begin(offset.y);
        columns = (width - x0 + block - 1) / block, rows = (height - y0 + block - 1) / block;
    }
    PixelRectangle cell(int i) const {
        const int x = x0 + (i % columns) * block, y = y0 + (i / columns) * block;
        return {x, y, x + block, y + block};
    }
    /// Tents of two grids that lie half a block apart add up to 1.
    float tent(int from_edge) const {
        return 1.0f - std::fabs(float(2 * from_edge + 1) / float(block) - 1.0f);
    }
};

/// Part of the cell within the picture; and the cell moved to lie within it.
PixelRectangle clipped(const PixelRectangle& c, int width, int height) {
    return {std::max(c.x0, 0), std::max(c.y0, 0), std::min(c.x1, width), std::min(c.y1, height)};
}
PixelRectangle moved_inside(const PixelRectangle& c, int width, int height) {
    const int w = std::min(c.x1 - c.x0, width), h = std::min(c.y1 - c.y0, height);
    const int x = std::clamp(c.x0, 0, width - w), y = std::clamp(c.y0, 0, height - h);
    return {x, y, x + w, y + h};
}

/// Mean of the finite colours of a block: for pixels about which nothing is known. Black without any.
Rgb mean_colour(const PixelRectangle& block, std::size_t width, std::span<const Rgb> colour) {
    glm::dvec3 sum(0.0);
    double count = 0.0;
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x)
            if (const Rgb& c = colour[std::size_t(y) * width + std::size_t(x)]; is_finite(c))
                sum += glm::dvec3(c), count += 1.0;
    return count > 0.0 ? Rgb(sum / count) : Rgb(0.0f);
}

void check(int width, int height, std::span<const FeaturePlane> features, std::span<const Rgb> colour,
           const RegressionSettings& settings) {
    const std::size_t pixels = std::size_t(std::max(width, 0)) * std::size_t(std::max(height, 0));
    if (pixels == 0 || colour.size() != pixels)
        throw std::invalid_argument("a regression needs a picture of its size");
    if (std::any_of(features.begin(), features.end(),
                    [&](const FeaturePlane& f) { return f.values.size() != pixels; }))
        throw std::invalid_argument("a feature does not have the size of the picture");
    if (settings.block < 2 || settings.block % 2) throw std::invalid_argument("blocks have an even side");
}

std::vector<std::uint8_t> pixels_with_features(std::span<const FeaturePlane> features, std::size_t pixels) {
    std::vector<std::uint8_t> result(pixels, 1);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels), [&](const auto& range) {
        for (const FeaturePlane& f : features)
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                result[i] = result[i] & std::uint8_t(std::isfinite(f.values[i]));
    });
    return result;
}

}  // namespace

Vec2i block_offset(int frame, int block) {
    // The R2 sequence: each new grid lies far from those before it.
    const auto part = [&](double step) {
        const double at = 0.5 + step * double(frame);
        return int((at - std::floor(at)) * block);
    };
    return {part(0.7548776662466927), part(0.5698402909980532)};
}

Regression block_regression(int width, int height, std::span<const FeaturePlane> features,
                            std::span<const Rgb> colour, const RegressionSettings& settings,
                            CancelToken cancelled) {
    check(width, height, features, colour, settings);
    Regression result{std::vector<Rgb>(colour.size(), Rgb(0.0f)), 0};
    const std::vector<std::uint8_t> has_features = pixels_with_features(features, colour.size());
    tbb::enumerable_thread_specific<FeatureBlock> blocks(
        [&] { return FeatureBlock(width, features, colour, has_features); });
    const int half = settings.block / 2;
    for (int g = 0; g < (settings.overlapping ? 4 : 1); ++g) {
        const BlockGrid grid(width, height, settings.block,
                             settings.offset + Vec2i(g % 2 ? half : 0, g / 2 ? half : 0));
        tbb::parallel_for(0, grid.columns * grid.rows, [&](int i) {
            cancelled.check();
            FeatureBlock& block = blocks.local();
            const PixelRectangle cell = grid.cell(i), own = clipped(cell, width, height),
                                 fitted = moved_inside(cell, width, height);
            const bool any = block.fit(fitted, settings, hash_keys(settings.seed, g, i));
            std::vector<Rgb> row(std::size_t(own.width()));
            for (int y = own.y0; y < own.y1; ++y) {
                const std::size_t first = std::size_t(y) * std::size_t(width) + std::size_t(own.x0);
                if (any) block.evaluate(own.x0, y, row);
                for (std::size_t k = 0; k < row.size(); ++k) {
                    const std::size_t p = first + k;
                    if ((!any || !has_features[p]) && !is_finite(colour[p]))
                        row[k] = mean_colour(fitted, std::size_t(width), colour);
                    if (settings.keep_positive) row[k] = glm::max(row[k], Rgb(0.0f));
                    const float weight = settings.overlapping
                                             ? grid.tent(y - cell.y0) * grid.tent(own.x0 + int(k) - cell.x0)
                                             : 1.0f;
                    result.colour[p] += weight * row[k];
                }
            }
        });
    }
    for (std::size_t p = 0; p < colour.size(); ++p) {
        if (!is_finite(colour[p]))
            ++result.filled;
        else if (!has_features[p])
            result.colour[p] = colour[p];
    }
    return result;
}

}  // namespace mote::screenspace
