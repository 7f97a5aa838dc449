// Methods over plain arrays of another renderer: screen-space bias compensation with the area of each pixel's
// patch, bilateral upsampling, block-wise regression (BMFR), and visibility queries in a picture of item
// numbers. A camera at the origin looks along z into a corner: a wall at z = 4 and a floor at y = 1 (down).
#include <mote/core/math/random.h>
#include <mote/screenspace/denoising/block_regression.h>
#include <mote/screenspace/ssbc/ssbc.h>
#include <mote/screenspace/upsampling/upsampling.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace mote;
using core::Rgb, core::Vec3;
namespace ss = screenspace;

constexpr int width = 96, height = 96, pixels = width * height;

/// First surface of a pixel.
struct Seen {
    Vec3 position, normal;
    float distance, cosine;  ///< cosine of the normal with the way to the camera
    std::uint32_t item;
};

Seen seen(int i) {
    const Vec3 film((float(i % width) + 0.5f) / width - 0.5f, (float(i / width) + 0.5f) / height - 0.5f,
                    1.0f);
    const Vec3 direction = glm::normalize(film);
    const float to_wall = 4.0f / direction.z,
                to_floor = direction.y > 0.0f ? 1.0f / direction.y : core::infinity;
    const bool floor = to_floor < to_wall;
    const Vec3 normal = floor ? Vec3(0, -1, 0) : Vec3(0, 0, -1);
    const float t = std::min(to_wall, to_floor);
    return {t * direction, normal, t, -glm::dot(normal, direction), floor ? 1u : 0u};
}

/// `area` of a pixel's patch: the pixel's solid angle, times the squared distance, over the cosine at the
/// surface. The solid angle is that of the film's pixel at distance 1, its area times the third power of the
/// cosine on the film.
float patch_area(const Seen& s) {
    const float on_film = s.position.z / s.distance;
    return on_film * on_film * on_film / float(pixels) * s.distance * s.distance / s.cosine;
}

int main() {
    std::vector<Seen> view;
    for (int i = 0; i < pixels; ++i) view.push_back(seen(i));
    int wrong = 0;
    const auto expect = [&](bool holds, const char* what, double value) {
        std::printf("%-64s %.4g%s\n", what, value, holds ? "" : "   WRONG"), wrong += !holds;
    };

    // SSBC: a corner of radiance 1 gets light where the two planes are near each other, and nowhere else.
    ss::SsbcSurfaces surfaces(width, height);
    double wall_area = 0.0;
    for (int i = 0; i < pixels; ++i) {
        const Seen& s = view[std::size_t(i)];
        surfaces.set(std::size_t(i), s.position, s.normal, -s.position, patch_area(s), Rgb(0.5f));
        wall_area += s.item == 0 ? double(surfaces.area[std::size_t(i)]) : 0.0;
    }
    expect(std::fabs(wall_area / 12.0 - 1.0) < 0.03,
           "area of the wall's patches, which is 4 x 3 m^2:", wall_area);
    const auto added =
        ss::compensate(surfaces, std::vector<Rgb>(pixels, Rgb(1.0f)), {.bound = 1.0f}).compensation;
    double corner = 0.0, far = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (view[i].position.y < -1.0f)
            far = std::max(far, double(added[i].x));  // more than 1 m from the floor
        if (view[i].position.y > 0.9f) corner = std::max(corner, double(added[i].x));
    }
    expect(corner > 0.01 && far < 1e-4, "compensation in the corner, and none far from it:", corner);

    // BMFR: noise over a picture that is linear in the features.
    core::Rng rng(3);
    std::vector<float> x(pixels), y(pixels);
    std::vector<Rgb> truth(pixels), noisy(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        x[i] = view[i].position.x, y[i] = view[i].position.y + view[i].position.z;
        truth[i] = Rgb(3.0f + x[i] - 0.2f * y[i]), noisy[i] = truth[i] + Rgb(rng.next_float() - 0.5f);
    }
    const ss::FeaturePlane features[] = {{x}, {y}};
    const auto fit = ss::block_regression(width, height, features, noisy, {});
    double before = 0.0, after = 0.0;
    for (std::size_t i = 0; i < pixels; ++i)
        before += std::pow(double(noisy[i].x - truth[i].x), 2.0),
            after += std::pow(double(fit.colour[i].x - truth[i].x), 2.0);
    expect(after / before < 0.05, "fraction of the squared error that BMFR leaves:", after / before);

    // Upsampling: light of every third pixel, constant on each plane, between them.
    std::vector<ss::UpsamplingPoint> points(pixels);
    std::vector<Rgb> light(pixels, Rgb(0.0f));
    const ss::ShadedLattice lattice{3, 1, 1};
    for (std::size_t i = 0; i < pixels; ++i) {
        points[i].position = view[i].position, points[i].normal = points[i].shading_normal = view[i].normal;
        points[i].footprint = view[i].distance / width, points[i].modulation = Rgb(1.0f);
    }
    const ss::Upsampling upsampling(width, height, lattice, ss::LayerKind::surface, points);
    const auto shade = [&](std::size_t i) { light[i] = Rgb(view[i].item == 0 ? 1.0f : 2.0f); };
    for (std::size_t i = 0; i < pixels; ++i)
        if (lattice.holds(int(i) % width, int(i) / width)) shade(i);
    for (const std::uint32_t i : upsampling.again()) shade(i);  // pixels without a neighbour that fits
    upsampling.fill(light);
    double off = 0.0;
    for (std::size_t i = 0; i < pixels; ++i)
        off = std::max(off, std::fabs(double(light[i].x) - (view[i].item == 0 ? 1.0 : 2.0)));
    expect(off < 1e-3, "largest error of upsampling two planes:", off);
    return wrong;
}
