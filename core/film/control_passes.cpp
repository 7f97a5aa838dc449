#include "core/film/control_passes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <string>

#include "core/film/film_memory.h"
#include "core/math/random.h"
#include "core/metrics/neighbourhood.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

constexpr double pixels_for_each = 100.0;  ///< of the film, about
constexpr double min_count = 256.0, max_count = 4096.0;
constexpr double min_rows = 4.0;  ///< they show a variance
constexpr double min_importance = 0.25;
constexpr std::uint64_t choice_key = 0x636f6e74726f6cull;

std::vector<Layer> layer_of_each_part(std::size_t parts) {
    std::vector<Layer> layers;
    for (std::size_t part = 0; part < parts; ++part) {
        Layer& layer = layers.emplace_back();
        layer.name = "part" + std::to_string(part), layer.part = part;
    }
    return layers;
}

int count_of(double pixels) { return int(std::clamp(pixels / pixels_for_each, min_count, max_count)); }
int rows_of(double pixels) {
    return int(std::max(min_rows, std::round(ControlPasses::share * pixels / count_of(pixels))));
}

/// Means over 5 x 5 pixels, relative to the mean over all; 1 where there is nothing.
std::vector<double> smoothed(const std::vector<double>& values, int width, int height) {
    std::vector<double> result(values.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            double sum = 0.0, count = 0.0;
            for_each_near(x, y, width, height, [&](std::size_t q) { sum += values[q], count += 1.0; });
            result[std::size_t(y) * std::size_t(width) + std::size_t(x)] = sum / count;
        }
    const double mean = std::accumulate(result.begin(), result.end(), 0.0) / double(result.size());
    for (double& value : result) value = mean > 0.0 ? value / mean : 1.0;
    return result;
}

/// |f_q - f_p|^2, the mean over the 5 x 5 pixels q around p.
double difference_from_neighbours(const std::vector<Rgb>& f, std::size_t p, int width, int height) {
    double sum = 0.0, count = 0.0;
    for_each_near(int(p) % width, int(p) / width, width, height, [&](std::size_t q) {
        sum += product_of_differences(f[q], f[p], f[q], f[p]), count += 1.0;
    });
    return sum / count;
}

}  // namespace

std::vector<double> importance_for_error(const Film& film) {
    const int width = film.width(), height = film.height();
    const Film::HalfBeauty a = film.half_beauty(0), b = film.half_beauty(1);
    const std::vector<Rgb> shown = film.beauty();
    const RelativeWeights weights = relative_weights(shown, width, height);
    std::vector<double> left(film.pixels()), noise(film.pixels()), edges(film.pixels());
    for (std::size_t p = 0; p < film.pixels(); ++p) {
        const double w = weights.weight[p];
        left[p] = w * product_of_differences(a.shown[p], b.shown[p], a.shown[p], b.shown[p]);
        // The geometric mean of both halves: a rare bright path is in one alone.
        noise[p] = w * std::sqrt(mean_of_channels(a.variance[p]) * mean_of_channels(b.variance[p]));
        edges[p] = w * difference_from_neighbours(shown, p, width, height);
    }
    for (std::vector<double>* values : {&left, &noise, &edges}) *values = smoothed(*values, width, height);
    std::vector<double> importance(film.pixels());
    for (std::size_t p = 0; p < film.pixels(); ++p)
        importance[p] = min_importance + (1.0 - min_importance) * (left[p] + noise[p] + edges[p]) / 3.0;
    return importance;
}

ControlPasses::ControlPasses(const Film& film)
    : width_(film.width()), height_(film.height()), sums_(1, 1, {}) {
    if (film.kept().split != PassSplit::halves) throw std::invalid_argument("control passes need halves");
    const double pixels = double(film.pixels());
    count_ = std::size_t(count_of(pixels));
    sums_ = Film(count_of(pixels), rows_of(pixels), layer_of_each_part(film.parts()));
}

double ControlPasses::memory(int width, int height, std::span<const Layer> layers) {
    const double pixels = double(width) * double(height);
    std::size_t parts = 1;
    for (const Layer& layer : layers) parts = std::max(parts, layer.part + 1);
    const std::vector<Layer> summed = layer_of_each_part(parts);
    return FilmMemory(count_of(pixels), rows_of(pixels), summed).peak() + pixels * sizeof(float);
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
    columns_ = {std::move(pixels), sums_.height()};
    represented_ = std::move(represented);
}

void ControlPasses::add_pass(const PassImage& light, std::size_t part) {
    if (light.width() != columns_.columns() || light.height() != columns_.rows() || light.layers() != 1)
        throw std::invalid_argument("the control pass does not fit");
    sums_.add_pass(light, part);
}

ControlPixels ControlPasses::pixels(const Film& film) const {
    std::vector<ControlPixel> controls;
    for (std::size_t part = 0; !empty() && part < film.parts(); ++part)
        if (sums_.pass_count(part) > 0) controls.resize(count_);
    if (controls.empty()) return {};
    for (std::size_t i = 0; i < count_; ++i) controls[i].pixel = index_of(i);
    for (std::size_t part = 0; part < film.parts(); ++part)
        if (sums_.pass_count(part) > 0)
            add_own_samples(controls, part);
        else
            for (const std::size_t half : {0u, 1u}) {
                const Film::PartHalf of_part = film.part_half(part, int(half));
                for (ControlPixel& c : controls) c.mean[half] += of_part.mean[c.pixel];
            }
    return {std::move(controls), represented_};
}

void ControlPasses::add_own_samples(std::vector<ControlPixel>& controls, std::size_t part) const {
    const std::vector<Rgb> samples = sums_.mean(part);
    const std::size_t rows = std::size_t(columns_.rows());
    for (std::size_t i = 0; i < count_; ++i) {
        // Rows of even and of odd index are two estimates.
        std::array<Vec3d, 2> sum{Vec3d(0.0), Vec3d(0.0)}, squares = sum;
        for (std::size_t row = 0; row < rows; ++row) {
            const Vec3d sample(samples[row * count_ + i]);
            sum[row % 2] += sample, squares[row % 2] += sample * sample;
        }
        for (Rgb& of_half : controls[i].mean) of_half += Rgb((sum[0] + sum[1]) / double(rows));
        for (const std::size_t odd : {0u, 1u}) {
            const double n = double((rows + 1 - odd) / 2);
            const Vec3d variance = (squares[odd] - sum[odd] * sum[odd] / n) / (n - 1.0);
            controls[i].variance[odd] += Rgb(glm::max(variance, Vec3d(0.0)) / double(rows));
        }
    }
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
