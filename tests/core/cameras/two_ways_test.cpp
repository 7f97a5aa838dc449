// A pixel's value by rays from the camera and by points of the scene that are connected to it: a lamp of even
// radiance that fills the view, where every pixel is 1 by definition, and one that fills a part of it.
#include "core/math/random.h"
#include "core/render/render_driver.h"
#include "core/render/splat.h"
#include "tests/core/cameras/camera_cases.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

constexpr int samples = 1000000, pixel_count = film_width * film_height;
constexpr double sigmas = 5.0;  // with 3,000 comparisons a right program fails with a chance of 0.2 %

/// Sums over independent samples, each of which is zero in most pixels.
struct Picture {
    double sum[pixel_count] = {}, squares[pixel_count] = {};
    double whole = 0.0, whole_squares = 0.0, of_this_sample = 0.0;  ///< all pixels together
    void add(int x, int y, double value) {
        sum[y * film_width + x] += value, squares[y * film_width + x] += value * value;
        of_this_sample += value;
    }
    void end_sample() {
        whole += of_this_sample, whole_squares += of_this_sample * of_this_sample, of_this_sample = 0.0;
    }
};
struct Estimated {
    double mean, variance_of_mean;
};
Estimated estimated(double sum, double squares, double n) {
    const double mean = sum / n;
    return {mean, (squares / n - mean * mean) / n};
}

/// A lamp of radiance 1: the parallelogram center +- s +- t.
struct Lamp {
    Vec3 center, s, t;
    Vec3 normal() const { return glm::normalize(glm::cross(s, t)); }
    float area() const { return 4.0f * glm::length(glm::cross(s, t)); }
    bool hit_by(const Ray& ray) const {
        const float along = glm::dot(center - ray.origin, normal()) / glm::dot(ray.direction, normal());
        const Vec3 d = ray.at(along) - center;
        // By Cramer's rule in the lamp's plane.
        const Vec3 n = glm::cross(s, t);
        const float a = glm::dot(glm::cross(d, t), n) / glm::dot(n, n),
                    b = glm::dot(glm::cross(s, d), n) / glm::dot(n, n);
        return along > ray.t_min && along < ray.t_max && std::fabs(a) < 1.0f && std::fabs(b) < 1.0f;
    }
};

/// Four metres before the camera, tilted by some twenty degrees.
Lamp lamp_before(const CameraCase& c, float half_size) {
    const Vec3 x = glm::normalize(c.axis({1, 0, 0})), y = glm::normalize(c.axis({0, 1, 0}));
    return {c.camera().position() + 4.0f * c.forward(), half_size * (x + 0.3f * c.forward()), half_size * y};
}

struct Planted {
    float margin_factor = 1.0f;   ///< 0: pixels at the border do not look beyond it
    bool without_cosine = false;  ///< of the lamp
};

Picture from_the_lamp(const CameraCase& c, const Lamp& lamp, const PixelFilter& filter,
                      const Planted& planted = {}) {
    Picture picture;
    Rng rng(11);
    for (int i = 0; i < samples; ++i) {
        const Vec2 u = 2.0f * rng.next_vec2() - 1.0f;
        const Vec3 p = lamp.center + u.x * lamp.s + u.y * lamp.t;
        const auto s =
            c.camera().sample_importance(p, rng.next_vec2(), planted.margin_factor * filter.radius());
        if (!s) continue;
        const float cosine = planted.without_cosine ? 1.0f : std::fabs(glm::dot(lamp.normal(), s->wi));
        for_each_splat(filter, s->film_position, film_width, film_height, [&](int x, int y, float f) {
            picture.add(x, y, double(s->weight * cosine * lamp.area() * f));
        });
        picture.end_sample();
    }
    return picture;
}

constexpr int rays_per_pixel = samples / pixel_count;
Picture from_the_camera(const CameraCase& c, const Lamp& lamp, const PixelFilter& filter) {
    Picture picture;
    Rng rng(12);
    for (int y = 0; y < film_height; ++y)
        for (int x = 0; x < film_width; ++x)
            for (int i = 0; i < rays_per_pixel; ++i) {
                const Vec2 film =
                    Vec2(float(x) + 0.5f, float(y) + 0.5f) + filter.sample_offset(rng.next_vec2());
                picture.add(x, y, lamp.hit_by(c.camera().sample_ray(film, rng.next_vec2())) ? 1.0 : 0.0);
            }
    return picture;
}

bool differ(const Estimated& a, const Estimated& b) {
    return !(std::fabs(a.mean - b.mean) <=
             sigmas * std::sqrt(a.variance_of_mean + b.variance_of_mean) + 1e-5);
}
Estimated light_pixel(const Picture& light, int i) {
    return estimated(light.sum[i], light.squares[i], samples);
}
Estimated light_mean(const Picture& light) {
    return estimated(light.whole / pixel_count, light.whole_squares / (pixel_count * pixel_count), samples);
}
/// Pixels that are not 1.
int pixels_off(const Picture& light) {
    int off = 0;
    for (int i = 0; i < pixel_count; ++i) off += differ(light_pixel(light, i), {1.0, 0.0});
    return off;
}
bool mean_off(const Picture& light) { return differ(light_mean(light), {1.0, 0.0}); }

/// Pixels that differ from those of rays; where thirty rays or fewer should hit the lamp, normal errors
/// cannot be expected, and the picture's mean must do.
int pixels_off(const Picture& light, const Picture& eye) {
    int off = 0;
    Estimated eye_mean{0.0, 0.0};
    for (int i = 0; i < pixel_count; ++i) {
        const Estimated a = light_pixel(light, i), b = estimated(eye.sum[i], eye.squares[i], rays_per_pixel);
        eye_mean.mean += b.mean / pixel_count;
        eye_mean.variance_of_mean += b.variance_of_mean / (pixel_count * pixel_count);
        off += a.mean * rays_per_pixel > 30.0 && differ(a, b);
    }
    return off + (differ(light_mean(light), eye_mean) ? 1 : 0);
}

std::vector<std::unique_ptr<PixelFilter>> filters() {
    std::vector<std::unique_ptr<PixelFilter>> all;
    all.push_back(make_pixel_filter("box", 0.5f, 0.5f));
    all.push_back(make_pixel_filter("tent", 1.0f, 0.5f));
    all.push_back(make_pixel_filter("gaussian", 2.0f, 0.5f));
    return all;
}

}  // namespace

TEST_CASE("an even lamp that fills the view has every pixel at 1 from its own side", "[cameras][splat]") {
    for (const CameraCase& c : camera_cases()) {
        if (c.name.find("wide") != std::string::npos) continue;  // that lamp would reach behind the camera
        const Lamp lamp = lamp_before(c, 2.6f);
        for (const auto& filter : filters()) {
            INFO(c.name << ", radius " << filter->radius());
            const Picture light = from_the_lamp(c, lamp, *filter);
            CHECK(pixels_off(light) == 0);
            CHECK_FALSE(mean_off(light));
        }
    }
}

TEST_CASE("an even lamp that fills a part of the view is the same from both ends", "[cameras][splat]") {
    for (const CameraCase& c : camera_cases()) {
        const bool wide = c.name.find("wide") != std::string::npos;
        const Lamp lamp = lamp_before(c, wide ? 3.0f : 0.8f);
        for (const auto& filter : filters()) {
            INFO(c.name << ", radius " << filter->radius());
            const Picture eye = from_the_camera(c, lamp, *filter);
            CHECK(pixels_off(from_the_lamp(c, lamp, *filter), eye) == 0);
            CHECK(eye.sum[pixel_count / 2 + film_width / 2] > 0.0);
        }
    }
}

TEST_CASE("planted errors of splats are seen", "[cameras][splat][planted]") {
    const auto gaussian = make_pixel_filter("gaussian", 2.0f, 0.5f);
    for (const CameraCase& c : camera_cases()) {
        if (c.name.find("wide") != std::string::npos) continue;
        INFO(c.name);
        const Lamp lamp = lamp_before(c, 2.6f);
        // The border alone looks beyond the film.
        const int border = pixels_off(from_the_lamp(c, lamp, *gaussian, {.margin_factor = 0.0f}));
        CHECK(border >= film_width + film_height);
        CHECK(border <= 4 * (film_width + film_height));
        CHECK(mean_off(from_the_lamp(c, lamp, *gaussian, {.without_cosine = true})));
        // The lens, the film or the filter too large or too small.
        for (const double factor : {0.97, 1.03}) {
            Picture wrong = from_the_lamp(c, lamp, *gaussian);
            REQUIRE_FALSE(mean_off(wrong));
            wrong.whole *= factor, wrong.whole_squares *= factor * factor;
            CHECK(mean_off(wrong));
        }
    }
}
