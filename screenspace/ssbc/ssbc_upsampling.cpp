#include "screenspace/ssbc/ssbc_upsampling.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "screenspace/ssbc/ssbc_receivers.h"

namespace mote::screenspace {

using namespace core;

namespace {

constexpr std::uint32_t none = ~std::uint32_t(0);

struct Mean {
    Rgb value{0.0f};
    float weight = 0.0f, least = infinity, most = -infinity;

    void add(const Rgb& sample, float w) {
        if (!(w > 0.0f)) return;
        value += w * sample, weight += w;
        least = std::min(least, average(sample)), most = std::max(most, average(sample));
    }
    bool defective(const UpsamplingRules& rules) const {
        return !(weight > 0.0f) || weight < rules.min_weight ||
               most - least > rules.contrast * std::abs(average(value)) / weight;
    }
};

/// The evaluated pixels as a grid of half the size.
struct Samples {
    int width, height;
    std::vector<std::uint32_t> pixel;

    Samples(const SsbcSurfaces& surfaces, std::span<const std::uint32_t> evaluated)
        : width((surfaces.width + 1) / 2), height((surfaces.height + 1) / 2) {
        pixel.assign(std::size_t(width) * std::size_t(height), none);
        for (const std::uint32_t p : evaluated) {
            const int x = int(p) % surfaces.width / 2, y = int(p) / surfaces.width / 2;
            pixel[std::size_t(y) * std::size_t(width) + std::size_t(x)] = p;
        }
    }
    std::uint32_t at(int x, int y) const {
        return x < width && y < height ? pixel[std::size_t(y) * std::size_t(width) + std::size_t(x)] : none;
    }
};

Mean mean_around(const SsbcSurfaces& surfaces, const Samples& samples, int x, int y, float sine,
                 std::span<const Rgb> irradiance) {
    Mean mean;
    const std::size_t here = std::size_t(y) * std::size_t(surfaces.width) + std::size_t(x);
    for (int j = y / 2; j <= y / 2 + 1; ++j)
        for (int i = x / 2; i <= x / 2 + 1; ++i) {
            const std::uint32_t p = samples.at(i, j);
            if (p == none) continue;
            const int dx = std::abs(int(p) % surfaces.width - x), dy = std::abs(int(p) / surfaces.width - y);
            if (dx >= 2 || dy >= 2) continue;
            const float tent = (1.0f - 0.5f * float(dx)) * (1.0f - 0.5f * float(dy));
            mean.add(irradiance[p], tent * same_surface(surfaces, here, p, sine));
        }
    return mean;
}

}  // namespace

float same_surface(const SsbcSurfaces& s, std::size_t a, std::size_t b, float sine) {
    const Vec3 d = s.position[b] - s.position[a];
    const float length = glm::length(d), aligned = glm::dot(s.normal[a], s.normal[b]);
    if (aligned <= 0.0f) return 0.0f;
    const float turned = safe_sqrt(1.0f - sqr(aligned));
    const float off_plane = length > 0.0f ? std::abs(glm::dot(s.normal[a], d)) / length : 0.0f;
    return std::max(0.0f, 1.0f - turned / sine) * std::max(0.0f, 1.0f - off_plane / sine);
}

std::vector<std::uint32_t> half_resolution_pixels(const SsbcSurfaces& surfaces) {
    const int width = (surfaces.width + 1) / 2, height = (surfaces.height + 1) / 2;
    std::vector<std::uint32_t> pixels;
    for (const std::uint32_t cell : cells_along_z_curve(width, height, [](int, int) { return true; })) {
        const int x0 = 2 * int(cell % std::uint32_t(width)), y0 = 2 * int(cell / std::uint32_t(width));
        std::uint32_t found = none;
        for (int y = y0; y < std::min(y0 + 2, surfaces.height) && found == none; ++y)
            for (int x = x0; x < std::min(x0 + 2, surfaces.width) && found == none; ++x) {
                const auto p = std::uint32_t(y) * std::uint32_t(surfaces.width) + std::uint32_t(x);
                if (surfaces.area[p] > 0.0f) found = p;
            }
        if (found != none) pixels.push_back(found);
    }
    return pixels;
}

std::vector<std::uint32_t> upsample(const SsbcSurfaces& surfaces, std::span<const std::uint32_t> evaluated,
                                    const UpsamplingRules& rules, std::span<Rgb> irradiance) {
    const Samples samples(surfaces, evaluated);
    const float sine = std::sin(rules.angle);
    const std::vector<Rgb> known(irradiance.begin(), irradiance.end());
    std::vector<std::uint8_t> defective(surfaces.pixel_count(), 0);
    tbb::parallel_for(0, surfaces.height, [&](int y) {
        for (int x = 0; x < surfaces.width; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(surfaces.width) + std::size_t(x);
            if (!(surfaces.area[i] > 0.0f) || samples.at(x / 2, y / 2) == i) continue;
            const Mean mean = mean_around(surfaces, samples, x, y, sine, known);
            if (mean.defective(rules))
                defective[i] = 1;
            else
                irradiance[i] = mean.value / mean.weight;
        }
    });
    return cells_along_z_curve(surfaces.width, surfaces.height, [&](int x, int y) {
        return defective[std::size_t(y) * std::size_t(surfaces.width) + std::size_t(x)] != 0;
    });
}

}  // namespace mote::screenspace
