// Denoising by block-wise regression on features (BMFR), over arrays of another renderer: noise over an image
// that is linear in the features of each pixel, as one picture and as a sequence of eight frames.
#include <mote/core/math/random.h>
#include <mote/screenspace/denoising/block_regression.h>
#include <mote/screenspace/denoising/sequence_denoiser.h>

#include <cstdio>

#include "../corner.h"

using namespace mote;
using core::Rgb;

/// Sum of squared differences.
double squared_error(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += double(glm::dot(a[i] - b[i], a[i] - b[i]));
    return sum;
}

int main() {
    const std::vector<corner::Seen> view = corner::view();
    std::vector<core::Vec3> position, normal;
    // Features without noise; a feature that differs between surfaces keeps their edges: the normal.
    std::vector<float> x, y, z, normal_y;
    std::vector<Rgb> truth, noisy;
    core::Rng rng(3);
    for (const corner::Seen& s : view) {
        x.push_back(s.position.x), y.push_back(s.position.y), z.push_back(s.position.z);
        normal_y.push_back(s.normal.y);
        position.push_back(s.position), normal.push_back(s.normal);
        truth.push_back(Rgb(3.0f + s.position.x - 0.2f * s.position.y) +
                        (s.floor ? Rgb(1, 0, 0) : Rgb(0.0f)));
        noisy.push_back(truth.back() + Rgb(rng.next_float() - 0.5f));
    }
    const screenspace::FeaturePlane features[] = {
        {x, true}, {y, true}, {z, true}, {normal_y}};  // true: its square is a feature as well
    // Colours are light over albedo, so that textures are no noise; multiply them back afterwards.
    const auto fit = screenspace::block_regression(corner::width, corner::height, features, noisy, {});
    const double left = squared_error(fit.colour, truth) / squared_error(noisy, truth);
    std::printf("regression leaves %.1f %% of the squared error\n", 100.0 * left);

    // A sequence: each frame is accumulated where its points were seen before, then regressed, and
    // accumulated again. The camera stands still here; others fill motion, and albedo of each layer.
    screenspace::SequenceDenoiser denoiser;
    std::vector<Rgb> denoised;
    for (int frame = 0; frame < 8; ++frame) {
        for (std::size_t p = 0; p < noisy.size(); ++p) noisy[p] = truth[p] + Rgb(rng.next_float() - 0.5f);
        screenspace::DenoiserFrame next;
        next.features.width = corner::width, next.features.height = corner::height;
        next.features.position = position, next.features.normal = normal;
        screenspace::DenoiserLayer& light = next.layers.emplace_back();
        light.colour = noisy, light.features.assign(std::begin(features), std::end(features));
        denoised = denoiser.add(next);
    }
    const double after = squared_error(denoised, truth) / squared_error(noisy, truth);
    std::printf("after eight frames %.1f %% are left\n", 100.0 * after);
    return left < 0.05 && after < 0.5 * left ? 0 : 1;
}
