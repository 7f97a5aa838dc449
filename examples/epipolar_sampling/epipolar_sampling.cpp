// Epipolar sampling of a depth buffer: light of a lamp scattered once by thin fog before a wall with a step,
// marched at a few places along lines through the lamp and interpolated in between. Each ray that is marched
// instead is the truth.
#include <mote/screenspace/epipolar/epipolar_picture.h>
#include <mote/screenspace/in_scattering/airlight.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace mote;
using core::Ray, core::Rgb, core::Vec3;
using namespace mote::screenspace;

constexpr int width = 320, height = 200;
constexpr float sigma = 0.05f;                   // extinction and scattering of the fog [1/m]
const Vec3 lamp{0.5f, 0.3f, 3.0f};               // in camera space: x right, y down, z forward [m]
std::vector<float> depth_buffer(width* height);  // z of what is seen [m]

/// Input of the method: view rays, their end points, and the in-scattered radiance along a few of them.
struct Pixels final : InScatteringTask {
    Ray ray(const Vec2d& film) override {
        return {Vec3(0.0f), glm::normalize(Vec3(film.x - width / 2, film.y - height / 2, width))};
    }
    RayEnd end_of(const Vec2d& film) override {
        const int x = std::clamp(int(film.x), 0, width - 1), y = std::clamp(int(film.y), 0, height - 1);
        const Ray r = ray(film);
        RayEnd end{.distance = depth_buffer[std::size_t(y * width + x)] / r.direction.z, .surface = true};
        const PassingRay passing(r, lamp);
        end.weight = float((passing.angle(end.distance) - passing.angle(0.0)) / passing.distance);
        end.position = r.at(end.distance), end.normal = {0.0f, 0.0f, -1.0f};
        return end;
    }
    MarchedRay march(const Vec2d& film, const RayEnd& end) override {
        const double light =
            sigma * airlight(PassingRay(ray(film), lamp), 0.0, double(end.distance), sigma, 0.0);
        return {Rgb(float(light)), Rgb(std::exp(-sigma * end.distance))};
    }
};
struct Source final : InScatteringSource {
    std::unique_ptr<InScatteringTask> start() const override { return std::make_unique<Pixels>(); }
};

int main() {
    for (int i = 0; i < width * height; ++i) depth_buffer[std::size_t(i)] = i % width < 200 ? 6.0f : 4.0f;
    const FilmPoint on_film{double(lamp.x / lamp.z) * width + width / 2,
                            double(lamp.y / lamp.z) * width + height / 2, 1.0};
    const auto loop = [](int count, const std::function<void(int)>& body) {
        for (int i = 0; i < count; ++i) body(i);
    };
    const Source source;
    EpipolarPicture picture(EpipolarLines(on_film, {{0.0, 0.0}, {width, height}}, 256, 0.5), {}, source,
                            loop);

    Pixels pixels;
    double error = 0.0, light = 0.0;
    std::size_t marched = picture.counts().marched;
    for (int i = 0; i < width * height; ++i) {
        const Vec2d film{i % width + 0.5, i / width + 0.5};
        const RayEnd end = pixels.end_of(film);
        const double truth = double(pixels.march(film, end).radiance.x);
        const auto found = picture.light_at(film, end, pixels);
        marched += !found;  // the method leaves this one to the caller
        error += found ? std::fabs(double(found->x) - truth) : 0.0, light += truth;
    }
    const double share = double(marched) / (width * height), mean_error = error / light;
    std::printf("%.1f %% of the rays were marched; the mean error is %.3f %%\n", 100.0 * share,
                100.0 * mean_error);
    return share < 0.1 && mean_error < 0.0005 ? 0 : 1;
}
