// Epipolar sampling of a depth buffer: light of a lamp scattered once by thin fog before a wall with a step,
// marched at a few places along lines through the lamp and interpolated in between. Each ray that is marched
// instead is the truth.
//
// A host whose camera is no pinhole, or that wants transmittance too, implements InScatteringTask and
// InScatteringSource and uses EpipolarPicture itself (epipolar_picture.h): light_over() does so in
// depth_buffer.cpp.
#include <mote/screenspace/epipolar/depth_buffer.h>
#include <mote/screenspace/in_scattering/airlight.h>

#include <cmath>
#include <cstdio>

using namespace mote;
using core::Ray, core::Rgb, core::Vec3;
using namespace mote::screenspace;

constexpr int width = 320, height = 200;
constexpr float sigma = 0.05f;      // extinction and scattering of the fog [1/m]
const Vec3 lamp{0.5f, 0.3f, 3.0f};  // in camera space: x right, y down, z forward [m]

/// The host's marching; here the integral is known.
Rgb march(const Vec2d& film, double distance) {
    const Ray ray{Vec3(0.0f), glm::normalize(Vec3(film.x - width / 2, film.y - height / 2, width))};
    return Rgb(float(sigma * airlight(PassingRay(ray, lamp), 0.0, distance, sigma, 0.0)));
}

int main() {
    std::vector<float> depth(width * height);  // z of what is seen [m]
    for (int i = 0; i < width * height; ++i) depth[std::size_t(i)] = i % width < 200 ? 6.0f : 4.0f;
    const DepthBuffer buffer{.width = width,
                             .height = height,
                             .depth = depth,
                             .far_distance = 100.0,
                             .focal_length = width,
                             .centre = {width / 2, height / 2},
                             .lamp = core::Vec3d(lamp)};
    const DepthBufferLight found = light_over(buffer, 256, {}, march);

    double error = 0.0, light = 0.0;
    for (int i = 0; i < width * height; ++i) {
        const Vec2d film{i % width + 0.5, i / width + 0.5};
        const double to_end = glm::length(core::Vec3d(film.x - width / 2, film.y - height / 2, width)) *
                              depth[std::size_t(i)] / width;
        const double truth = double(march(film, to_end).x);
        error += std::fabs(double(found.light[std::size_t(i)].x) - truth), light += truth;
    }
    const double share = double(found.marched) / (width * height), mean_error = error / light;
    std::printf("%.1f %% of the rays were marched; the mean error is %.3f %%\n", 100.0 * share,
                100.0 * mean_error);
    return share < 0.1 && mean_error < 0.0005 ? 0 : 1;
}
