#include "core/film/fine_sums.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

#include "core/film/for_each_pixel.h"

namespace mote::core {

namespace {

/// Rows of a band. Bands of even number are worked on at once, then those of odd number: samples fall at most
/// PassImage::max_reach rows away, so no two threads meet.
constexpr int band = 2 * PassImage::max_reach + 2;

}  // namespace

FineSums::FineSums(int width, int height) : width_(width), height_(height) {
    const std::size_t quarters = 4 * std::size_t(width) * std::size_t(height);
    light_ = ExactSums(3 * quarters), counts_.assign(quarters, 0.0f);
}

void FineSums::add(const PassImage& image, std::size_t layer) {
    if (empty() || !image.has_places()) return;
    if (image.width() != width_ || image.height() != height_)
        throw std::invalid_argument("the pass does not fit the film");
    const int bands = (height_ + band - 1) / band;
    for (const int parity : {0, 1})
        tbb::parallel_for(0, (bands + 1 - parity) / 2, [&](int i) {
            const int begin = (2 * i + parity) * band;
            add_rows(image, layer, begin, std::min(begin + band, height_));
        });
}

void FineSums::add_rows(const PassImage& image, std::size_t layer, int begin, int end) {
    const std::size_t first = std::size_t(begin) * std::size_t(width_),
                      last = std::size_t(end) * std::size_t(width_);
    for (std::size_t p = first; p < last; ++p) {
        const std::uint32_t place = image.places()[p];
        if (place == PassImage::nowhere) continue;
        const Rgb light = image.layer(layer)[p];
        if (!is_finite(light)) continue;
        for (int c = 0; c < 3; ++c) light_.add(3 * std::size_t(place) + std::size_t(c), double(light[c]));
        counts_[place] += 1.0f;
    }
}

void FineSums::add(const FineSums& more) {
    for_each_pixel(counts_.size(), [&](std::size_t q) {
        for (std::size_t i = 3 * q; i < 3 * q + 3; ++i) light_.add(i, more.light_);
        counts_[q] += more.counts_[q];
    });
}

std::vector<Rgb> FineSums::mean() const {
    std::vector<Rgb> result(counts_.size(), Rgb(0.0f));
    const auto sum = [&](std::size_t q) {
        return Vec3d(light_.at(3 * q), light_.at(3 * q + 1), light_.at(3 * q + 2));
    };
    tbb::parallel_for(0, height_, [&](int y) {
        for (int x = 0; x < width_; ++x) {
            const std::size_t of_pixel[4] = {quarter(2 * x, 2 * y), quarter(2 * x + 1, 2 * y),
                                             quarter(2 * x, 2 * y + 1), quarter(2 * x + 1, 2 * y + 1)};
            Vec3d all(0.0);
            double samples = 0.0;
            for (const std::size_t q : of_pixel) all += sum(q), samples += double(counts_[q]);
            for (const std::size_t q : of_pixel)
                if (samples > 0.0)
                    result[q] = Rgb(counts_[q] > 0.0f ? sum(q) / double(counts_[q]) : all / samples);
        }
    });
    return result;
}

}  // namespace mote::core
