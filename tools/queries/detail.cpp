#include "tools/queries/detail.h"

#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <ctime>
#include <functional>
#include <map>

#include "core/geometry/ray_tracer.h"
#include "core/geometry/triangle_mesh.h"
#include "core/math/random.h"
#include "screenspace/visibility/item_histogram.h"

namespace mote::queries {

using namespace core;

namespace {

constexpr float camera_distance = 4.0f, tangent = 0.33f;  // of half the field of view
constexpr int coarsest = 4;

struct Ball {
    Vec3 centre;
    float radius;
};

std::vector<Ball> crowd(const DetailSettings& s) {
    Rng rng(1);
    std::vector<Ball> balls;
    for (int i = 0; i < s.balls; ++i) {
        const Vec3 p(rng.next_float(), rng.next_float(), rng.next_float());
        balls.push_back({2.0f * p - 1.0f, s.radius * (0.5f + rng.next_float())});
    }
    return balls;
}

std::shared_ptr<Shape> mesh(const Ball& ball, int n) {
    MeshData data;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i < 2 * n; ++i) {
            const float theta = pi * float(j) / float(n), phi = pi * float(i) / float(n);
            const Vec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            data.positions.push_back(ball.centre + ball.radius * d);
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < 2 * n; ++i) {
            const auto at = [&](int column, int row) {
                return std::uint32_t(row * 2 * n + column % (2 * n));
            };
            if (j > 0) data.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            if (j + 1 < n) data.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return std::make_shared<TriangleMesh>(std::move(data));
}

/// Which ball every pixel shows, with meshes of these levels.
std::vector<std::uint32_t> picture(const DetailSettings& s, const std::vector<Ball>& balls,
                                   const std::vector<int>& levels) {
    std::vector<std::shared_ptr<Shape>> shapes(balls.size());
    tbb::parallel_for(std::size_t(0), balls.size(),
                      [&](std::size_t i) { shapes[i] = mesh(balls[i], levels[i]); });
    std::map<const Shape*, std::uint32_t> number;
    for (std::size_t i = 0; i < shapes.size(); ++i) number[shapes[i].get()] = std::uint32_t(i);
    const RayTracer tracer(shapes);
    std::vector<std::uint32_t> items(std::size_t(s.width) * std::size_t(s.height), screenspace::no_item);
    tbb::parallel_for(0, s.height, [&](int y) {
        for (int x = 0; x < s.width; ++x) {
            const float u = (2.0f * (float(x) + 0.5f) / float(s.width) - 1.0f) * tangent;
            const float v = (1.0f - 2.0f * (float(y) + 0.5f) / float(s.height)) * tangent * float(s.height) /
                            float(s.width);
            const Ray ray{{0, 0, camera_distance}, glm::normalize(Vec3(u, v, -1.0f))};
            if (const auto hit = tracer.closest(ray))
                items[std::size_t(y) * std::size_t(s.width) + std::size_t(x)] = number.at(hit->shape);
        }
    });
    return items;
}

/// A mesh whose cells are about two pixels wide on a disc of so many pixels.
int level_of(double pixels, int finest) {
    const double n = 0.5 * pi * std::sqrt(std::max(pixels, 0.0) / pi) / 2.0;
    return std::clamp(int(std::bit_ceil(unsigned(std::ceil(n)))), coarsest, finest);
}

double seconds_of(const std::function<void()>& work) {
    const std::clock_t start = std::clock();
    work();
    return double(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace

std::vector<DetailRow> compare_details(const DetailSettings& s) {
    const std::vector<Ball> balls = crowd(s);
    const std::vector<int> all(balls.size(), s.finest), few(balls.size(), coarsest);
    std::vector<int> by_size(few), by_pixels(few);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const float r =
            balls[i].radius / (camera_distance - balls[i].centre.z) / tangent * 0.5f * float(s.width);
        by_size[i] = level_of(pi * r * r, s.finest);
    }
    DetailRow visible{.by = "visible pixels"};
    visible.query_seconds = seconds_of([&] {
        const auto items = picture(s, balls, few);
        const screenspace::ItemHistogram counts(
            {s.width, s.height, items}, screenspace::ItemLayout::of_objects(std::uint32_t(balls.size()), 0));
        for (std::size_t i = 0; i < balls.size(); ++i) {
            by_pixels[i] = level_of(counts.pixels(std::uint32_t(i)), s.finest);
            visible.hidden += counts.pixels(std::uint32_t(i)) == 0;
        }
    });
    std::vector<std::uint32_t> finest;
    const auto measure = [&](DetailRow row, const std::vector<int>& levels) {
        std::vector<std::uint32_t> items;
        row.seconds = row.query_seconds + seconds_of([&] { items = picture(s, balls, levels); });
        for (const int n : levels) row.triangles += 4.0 * n * (n - 1);
        if (finest.empty()) finest = items;
        for (std::size_t i = 0; i < items.size(); ++i)
            row.changed += (items[i] != finest[i]) / double(items.size());
        return row;
    };
    return {measure({.by = "nothing"}, all), measure({.by = "size on the screen"}, by_size),
            measure(visible, by_pixels)};
}

}  // namespace mote::queries
