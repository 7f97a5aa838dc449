#include "core/metrics/halves_weights.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/metrics/neighbourhood.h"

namespace mote::core {

namespace {

double median_around(const std::vector<double>& squares, int x, int y, int width, int height) {
    std::array<double, 5 * 5> around{};
    std::size_t count = 0;
    for_each_near(x, y, width, height, [&](std::size_t q) { around[count++] = squares[q]; });
    const auto middle = around.begin() + std::ptrdiff_t(count / 2);
    std::nth_element(around.begin(), middle, around.begin() + std::ptrdiff_t(count));
    return *middle;
}

}  // namespace

RelativeWeights weights_of_halves(std::span<const Rgb> a, std::span<const Rgb> b, int width, int height) {
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    if (a.size() != pixels || b.size() != pixels) throw std::invalid_argument("the halves differ in size");
    std::vector<double> products(pixels), squares(pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        products[p] = std::max(0.0, glm::dot(glm::dvec3(a[p]), glm::dvec3(b[p])) / 3.0);
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t p = std::size_t(y) * std::size_t(width) + std::size_t(x);
            const double darker = std::min(mean_square(glm::dvec3(a[p])), mean_square(glm::dvec3(b[p])));
            squares[p] = std::max(median_around(products, x, y, width, height), darker);
        }
    });
    RelativeWeights result{weights_of_squares(squares)};
    for (std::size_t p = 0; p < pixels; ++p) {
        result.norm += result.weight[p] * mean_square(0.5 * (glm::dvec3(a[p]) + glm::dvec3(b[p])));
        result.noise_norm += result.weight[p] * squares[p];
    }
    return result;
}

}  // namespace mote::core
