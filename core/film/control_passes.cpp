#include "core/film/control_passes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <string>

#include "core/math/random.h"
#include "core/metrics/neighbourhood.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

constexpr double pixels_for_each = 100.0;  ///< of the film, about
constexpr double min_count = 256.0, max_count = 4096.0;
constexpr std::uint64_t choice_key = 0x636f6e74726f6cull;

std::vector<Layer> layer_of_each_part(std::size_t parts) {
    std::vector<Layer> layers;
    for (std::size_t part = 0; part < parts; ++part) {
        Layer& layer = layers.emplace_back();
        layer.name = "part" + std::to_string(part), layer.squares = true, layer.part = part;
    }
    return layers;
}

/// Means over 5 x 5 pixels, relative to the mean over all; 0 where there is nothing.
std::vector<double> smoothed(const std::vector<double>& values, int width, int height) {
    std::vector<double> result(values.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            double sum = 0.0, count = 0.0;
            for_each_near(x, y, width, height, [&](std::size_t q) { sum += values[q], count += 1.0; });
            result[std::size_t(y) * std::size_t(width) + std::size_t(x)] = sum / count;
        }
    const double mean = std::accumulate(result.begin(), result.end(), 0.0) / double(result.size());
    for (double& value : result) value = mean > 0.0 ? value / mean : 0.0;
    return result;
}

}  // namespace

std::vector<double> importance_for_error(const Film& film) {
    const Film::HalfBeauty a = film.half_beauty(0), b = film.half_beauty(1);
    const RelativeWeights weights = relative_weights(film.beauty());
    std::vector<double> left(film.pixels()), noise(film.pixels());
    for (std::size_t p = 0; p < film.pixels(); ++p) {
        const double w = weights.weight[p];
        left[p] = w * product_of_differences(a.shown[p], b.shown[p], a.shown[p], b.shown[p]);
        // The geometric mean of both halves: a rare bright path is in one alone.
        noise[p] = w * std::sqrt(mean_of_channels(a.variance[p]) * mean_of_channels(b.variance[p]));
    }
    left = smoothed(left, film.width(), film.height()), noise = smoothed(noise, film.width(), film.height());
    std::vector<double> importance(film.pixels());
    for (std::size_t p = 0; p < film.pixels(); ++p) importance[p] = 0.25 + 0.375 * left[p] + 0.375 * noise[p];
    return importance;
}

ControlPasses::ControlPasses(const Film& film)
    : width_(film.width()), height_(film.height()), sums_(1, 1, {}) {
    if (film.kept().split != PassSplit::halves) throw std::invalid_argument("control passes need halves");
    count_ = std::size_t(std::clamp(double(film.pixels()) / pixels_for_each, min_count, max_count));
    sums_ = Film(int(count_), 1, layer_of_each_part(film.parts()), false, PassSplit::halves);
}

void ControlPasses::choose(const Film& film, std::uint64_t seed) {
    const std::vector<double> importance = importance_for_error(film);
    const double all = std::accumulate(importance.begin(), importance.end(), 0.0);
    // One from each of so many shares of the importance, in the order of pixels.
    const double share_of_one = all / double(count_);
    std::vector<std::uint32_t> indices;
    Rng rng(hash_keys(seed, choice_key));
    double before = 0.0;
    std::size_t p = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const double at = (double(i) + double(rng.next_float())) * share_of_one;
        while (p + 1 < importance.size() && before + importance[p] <= at) before += importance[p++];
        indices.push_back(std::uint32_t(p));
    }
    std::vector<float> represented;
    for (const double of_pixel : importance) represented.push_back(float(share_of_one / of_pixel));
    set_pixels(indices, std::move(represented));
}

std::uint32_t ControlPasses::index_of(std::size_t i) const {
    const Vec2i at = columns_.at(int(i), 0);
    return std::uint32_t(at.y) * std::uint32_t(width_) + std::uint32_t(at.x);
}

void ControlPasses::set_pixels(std::span<const std::uint32_t> indices, std::vector<float> represented) {
    std::vector<Vec2i> pixels;
    for (const std::uint32_t index : indices)
        pixels.emplace_back(int(index % std::uint32_t(width_)), int(index / std::uint32_t(width_)));
    const double samples = share * double(width_) * double(height_);
    columns_ = {std::move(pixels), std::max(1, int(std::lround(samples / double(count_))))};
    represented_ = std::move(represented);
}

void ControlPasses::add_pass(const PassImage& light, std::size_t part) {
    if (light.width() != columns_.columns() || light.height() != columns_.rows() || light.layers() != 1)
        throw std::invalid_argument("the control pass does not fit");
    PassImage means(columns_.columns(), 1, 1);
    for (std::size_t i = 0; i < count_; ++i) {
        Vec3d sum(0.0);
        for (std::size_t row = 0; row < std::size_t(columns_.rows()); ++row)
            sum += Vec3d(light.layer(0)[row * count_ + i]);
        means.layer(0)[i] = Rgb(sum / double(columns_.rows()));
    }
    sums_.add_pass(means, part);
}

bool ControlPasses::has_halves(std::size_t part) const {
    return sums_.half_passes(part, 0) >= 2 && sums_.half_passes(part, 1) >= 2;
}

ControlPixels ControlPasses::pixels(const Film& film) const {
    std::vector<ControlPixel> controls;
    for (std::size_t part = 0; !empty() && part < film.parts(); ++part)
        if (has_halves(part)) controls.resize(count_);
    if (controls.empty()) return {};
    for (std::size_t i = 0; i < count_; ++i) controls[i].pixel = index_of(i);
    for (std::size_t part = 0; part < film.parts(); ++part)
        for (const int half : {0, 1}) {
            const bool own = has_halves(part);
            const Film::PartHalf of_part = own ? sums_.part_half(part, half) : film.part_half(part, half);
            for (std::size_t i = 0; i < count_; ++i) {
                const std::size_t p = own ? i : controls[i].pixel;
                controls[i].mean[std::size_t(half)] += of_part.mean[p];
                controls[i].variance[std::size_t(half)] += of_part.variance[p];
            }
        }
    return {std::move(controls), represented_};
}

std::vector<std::byte> ControlPasses::serialize() const {
    const std::vector<std::byte> sums = sums_.serialize();
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < count_; ++i) indices.push_back(index_of(i));
    const std::size_t of_indices = indices.size() * sizeof(std::uint32_t),
                      of_weights = represented_.size() * sizeof(float);
    std::vector<std::byte> bytes(of_indices + of_weights + sums.size());
    std::memcpy(bytes.data(), indices.data(), of_indices);
    std::memcpy(bytes.data() + of_indices, represented_.data(), of_weights);
    std::memcpy(bytes.data() + of_indices + of_weights, sums.data(), sums.size());
    return bytes;
}

void ControlPasses::deserialize(std::span<const std::byte> bytes) {
    const std::size_t pixels = std::size_t(width_) * std::size_t(height_),
                      of_indices = count_ * sizeof(std::uint32_t), of_weights = pixels * sizeof(float);
    if (count_ == 0 || bytes.size() < of_indices + of_weights)
        throw InputError("the control passes are cut short");
    std::vector<std::uint32_t> indices(count_);
    std::vector<float> represented(pixels);
    std::memcpy(indices.data(), bytes.data(), of_indices);
    std::memcpy(represented.data(), bytes.data() + of_indices, of_weights);
    const bool indices_fit = std::ranges::all_of(indices, [&](std::uint32_t i) { return i < pixels; }),
               numbers_fit = std::ranges::all_of(
                   represented, [&](float a) { return a > 0.0f && a <= 4.0f * float(pixels); });
    if (!indices_fit || !numbers_fit) throw InputError("the control passes are damaged");
    sums_.deserialize(bytes.subspan(of_indices + of_weights));
    set_pixels(indices, std::move(represented));
}

}  // namespace mote::core
