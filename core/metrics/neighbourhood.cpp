#include "core/metrics/neighbourhood.h"

#include "core/metrics/relative_error.h"

namespace mote::core {

AlikeNeighbours alike_neighbours(std::span<const Rgb> picture, std::span<const Rgb> variance, int x, int y,
                                 int width, int height) {
    constexpr double alike = 9.0;  // three standard deviations, squared
    const std::size_t p = std::size_t(y) * std::size_t(width) + std::size_t(x);
    const double own = mean_of_channels(variance[p]);
    AlikeNeighbours result;
    for_each_near(x, y, width, height, [&](std::size_t q) {
        if (q == p || mean_square(glm::dvec3(picture[q]) - glm::dvec3(picture[p])) >
                          alike * (own + mean_of_channels(variance[q])))
            return;
        result.sum += glm::dvec3(picture[q]), result.count += 1.0;
    });
    return result;
}

}  // namespace mote::core
