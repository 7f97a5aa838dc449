#include "screenspace/layer_filter/fine_pixels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "screenspace/layer_filter/oidn_features.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// The filter at the middles of the quarters around a pixel's middle, `reach` of them in each direction.
struct Kernel {
    int reach;
    std::vector<float> weights;

    explicit Kernel(const PixelFilter& filter) : reach(std::max(1, int(std::ceil(2.0f * filter.radius())))) {
        for (int y = -reach; y < reach; ++y)
            for (int x = -reach; x < reach; ++x)
                weights.push_back(filter.pdf_area(0.5f * (Vec2(float(x), float(y)) + 0.5f)));
    }
    float at(int x, int y) const { return weights[std::size_t((y + reach) * 2 * reach + x + reach)]; }
};

}  // namespace

std::vector<Rgb> by_pixel_filter(int width, int height, std::span<const Rgb> fine,
                                 const PixelFilter& filter) {
    if (fine.size() != 4 * std::size_t(width) * std::size_t(height))
        throw std::invalid_argument("pictures differ in size");
    const Kernel kernel(filter);
    const int columns = 2 * width, rows = 2 * height;
    std::vector<Rgb> result(std::size_t(width) * std::size_t(height));
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            // The pixel's middle lies between the quarters 2 x and 2 x + 1.
            const int left = std::max(-kernel.reach, -2 * x - 1),
                      right = std::min(kernel.reach, columns - 2 * x - 1);
            Rgb sum(0.0f);
            float weights = 0.0f;
            for (int j = std::max(-kernel.reach, -2 * y - 1); j < std::min(kernel.reach, rows - 2 * y - 1);
                 ++j)
                for (int i = left; i < right; ++i) {
                    const float w = kernel.at(i, j);
                    sum +=
                        w *
                        fine[std::size_t(2 * y + 1 + j) * std::size_t(columns) + std::size_t(2 * x + 1 + i)];
                    weights += w;
                }
            result[std::size_t(y) * std::size_t(width) + std::size_t(x)] =
                weights > 0.0f ? sum / weights : Rgb(0.0f);
        }
    });
    return result;
}

FinePixels::FinePixels(FineFeatures features, std::shared_ptr<const OidnLibrary> library,
                       std::unique_ptr<PixelFilter> filter)
    : features_(std::move(features)), library_(std::move(library)), filter_(std::move(filter)) {
    using Feature = OidnLibrary::Feature;
    FineFeatures& f = features_;
    const auto clean = [&](Feature which, std::vector<Rgb> values) {
        return without_noise(*library_, which, f.width, f.height, std::move(values));
    };
    f.reflected = clean(Feature::albedo, between_0_and_1(std::move(f.reflected)));
    if (!f.sharp) f.normal = clean(Feature::normal, std::move(f.normal));
}

std::vector<Rgb> FinePixels::denoised(std::span<const Rgb> fine) {
    const OidnLibrary::Picture picture{features_.width,     features_.height, fine,
                                       features_.reflected, features_.normal, true};
    if (!series_) series_.emplace(library_->series(picture));
    return by_pixel_filter(features_.width / 2, features_.height / 2, series_->denoised(picture), *filter_);
}

}  // namespace mote::screenspace
