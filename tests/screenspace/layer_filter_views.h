// Views of a few planes through a pinhole at the origin that looks along +z, as features of the layer filter,
// with the light of a layer in closed form.
#pragma once

#include <functional>
#include <random>

#include "screenspace/layer_filter/layer_filter.h"

namespace mote::tests {

/// Features and light of a ray through the pinhole. `light`: E for layers of surfaces; J for those of media.
struct Seen {
    screenspace::FeatureSample sample;
    core::Rgb light{0.0f};
};

struct FilterView {
    screenspace::FilterFeatures features;
    std::vector<core::Rgb> truth;  ///< of the layer: mean of the samples' modulation times light
};

/// Width of a pixel at distance 1.
inline constexpr float pixel_width = 0.01f;

inline core::Vec3 view_direction(float x, float y, int width, int height) {
    return glm::normalize(
        core::Vec3((x - 0.5f * float(width)) * pixel_width, (y - 0.5f * float(height)) * pixel_width, 1.0f));
}

/// A diffuse plane where the ray meets it in front of the eye; nothing otherwise.
inline Seen see_plane(const core::Vec3& direction, const core::Vec3& point, const core::Vec3& normal) {
    Seen seen;
    const float cosine = glm::dot(direction, normal);
    if (cosine >= 0.0f) return seen;
    seen.sample.hit = true;
    seen.sample.distance = glm::dot(point, normal) / cosine;
    seen.sample.position = direction * seen.sample.distance;
    seen.sample.normal = seen.sample.shading_normal = normal;
    seen.sample.reflected = core::Rgb(0.5f, 0.4f, 0.3f);
    return seen;
}

/// 4 x 4 samples a pixel.
inline FilterView make_view(int width, int height, screenspace::LayerKind kind,
                            const std::function<Seen(const core::Vec3& direction)>& see) {
    FilterView view{screenspace::FilterFeatures(width, height, 16), {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::vector<screenspace::FeatureSample> samples;
            core::Rgb sum(0.0f);
            for (int k = 0; k < 16; ++k) {
                const Seen seen = see(view_direction(float(x) + (float(k % 4) + 0.5f) / 4.0f,
                                                     float(y) + (float(k / 4) + 0.5f) / 4.0f, width, height));
                const bool surface = kind == screenspace::LayerKind::surface;
                sum += (surface ? seen.sample.reflected : seen.sample.scattering) * seen.light;
                samples.push_back(seen.sample);
            }
            const auto mean = screenspace::mean_surface(samples);
            screenspace::PixelFrame frame;
            if (mean.hit) {
                const auto meet = [&](float dx, float dy) {
                    const core::Vec3 d =
                        view_direction(float(x) + 0.5f + dx, float(y) + 0.5f + dy, width, height);
                    return d * (glm::dot(mean.position, mean.normal) / glm::dot(d, mean.normal));
                };
                const core::Vec3 a = meet(1, 0) - meet(0, 0), b = meet(0, 1) - meet(0, 0),
                                 n = glm::cross(a, b);
                frame = {glm::cross(b, n) / glm::dot(n, n), glm::cross(n, a) / glm::dot(n, n),
                         mean.distance * pixel_width};
            }
            const auto pixel = std::size_t(y) * std::size_t(width) + std::size_t(x);
            if (view.features.set_pixel(pixel, samples, frame)) {
                view.features.mixed.push_back(std::uint32_t(pixel));
                view.features.samples.insert(view.features.samples.end(), samples.begin(), samples.end());
            }
            view.truth.push_back(sum / 16.0f);
        }
    return view;
}

/// A wall at a slant.
inline Seen see_wall(const core::Vec3& d) {
    return see_plane(d, {0, 0, 4}, glm::normalize(core::Vec3(0.8f, -0.3f, -1)));
}

/// Two walls that meet at a right angle in the middle, lit unlike.
inline Seen see_corner(const core::Vec3& d) {
    const bool left = d.x < 0.0f;
    Seen seen = see_plane(d, {0, 0, 4}, glm::normalize(core::Vec3(left ? 1 : -1, 0, -1)));
    seen.light = left ? core::Rgb(4.0f, 3.0f, 2.0f) : core::Rgb(1.0f);
    return seen;
}

/// A plane at 3 m in the left half, before another at 3.5 m.
inline Seen see_step(const core::Vec3& d) {
    const bool left = d.x < 0.0f;
    Seen seen = see_plane(d, {0, 0, left ? 3.0f : 3.5f}, {0, 0, -1});
    seen.light = left ? core::Rgb(1.0f) : core::Rgb(0.0f);
    return seen;
}

/// Mean of `passes` normal random numbers around the truth, and its variance as a film would state it.
struct NoisyLayer {
    std::vector<core::Rgb> mean, variance;
    screenspace::LayerToFilter with(screenspace::LayerKind kind) const { return {mean, variance, kind}; }
};
inline NoisyLayer add_noise(const std::vector<core::Rgb>& truth, float deviation, int passes, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    NoisyLayer layer;
    for (const core::Rgb& t : truth) {
        core::Rgb mean, variance;
        for (int c = 0; c < 3; ++c) {
            double sum = 0.0, squares = 0.0;
            for (int k = 0; k < passes; ++k) {
                const double x = double(deviation) * normal(generator);
                sum += x, squares += x * x;
            }
            sum /= passes, squares /= passes;
            mean[c] = t[c] + float(sum), variance[c] = float((squares - sum * sum) / (passes - 1));
        }
        layer.mean.push_back(mean), layer.variance.push_back(variance);
    }
    return layer;
}

}  // namespace mote::tests
