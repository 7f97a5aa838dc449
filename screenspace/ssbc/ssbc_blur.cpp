#include "screenspace/ssbc/ssbc_blur.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "screenspace/ssbc/ssbc_upsampling.h"

namespace mote::screenspace {

using namespace core;

std::vector<Rgb> blurred(const SsbcSurfaces& surfaces, std::span<const Rgb> irradiance, float deviation,
                         float angle) {
    const int reach = int(std::ceil(2.0f * deviation));
    const float falloff = -0.5f / sqr(deviation), sine = std::sin(angle);
    const auto mean_at = [&](int x, int y) {
        const std::size_t here = std::size_t(y) * std::size_t(surfaces.width) + std::size_t(x);
        Rgb sum(0.0f);
        float weight = 0.0f;
        for (int j = std::max(0, y - reach); j <= std::min(surfaces.height - 1, y + reach); ++j)
            for (int i = std::max(0, x - reach); i <= std::min(surfaces.width - 1, x + reach); ++i) {
                const std::size_t p = std::size_t(j) * std::size_t(surfaces.width) + std::size_t(i);
                if (!(surfaces.area[p] > 0.0f)) continue;
                const float w = std::exp(falloff * float((i - x) * (i - x) + (j - y) * (j - y))) *
                                same_surface(surfaces, here, p, sine);
                sum += w * irradiance[p], weight += w;
            }
        return sum / weight;  // the pixel itself counts with 1
    };
    std::vector<Rgb> result(irradiance.begin(), irradiance.end());
    tbb::parallel_for(0, surfaces.height, [&](int y) {
        for (int x = 0; x < surfaces.width; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(surfaces.width) + std::size_t(x);
            if (surfaces.area[i] > 0.0f) result[i] = mean_at(x, y);
        }
    });
    return result;
}

}  // namespace mote::screenspace
