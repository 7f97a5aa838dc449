#include "screenspace/epipolar/depth_buffer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "screenspace/epipolar/epipolar_picture.h"
#include "screenspace/in_scattering/airlight.h"

namespace mote::screenspace {

using core::Ray, core::Rgb, core::Vec3;

namespace {

/// Rays of the camera, where they end, and their ways past the lamp.
class DepthView {
  public:
    explicit DepthView(const DepthBuffer& buffer) : b_(buffer), lamp_(buffer.lamp) {
        const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
        if (b_.width < 1 || b_.height < 1 || !positive(b_.focal_length) || !positive(b_.far_distance))
            throw std::invalid_argument("a size, a focal length and a far distance are needed");
        if (b_.depth.size() != std::size_t(b_.width) * std::size_t(b_.height))
            throw std::invalid_argument("the depth buffer has not one number a pixel");
        if (!std::isfinite(glm::dot(lamp_, lamp_)) || glm::dot(lamp_, lamp_) == 0.0f)
            throw std::invalid_argument("the lamp is not at the camera, and not at infinity");
    }

    FilmPoint lamp_on_film() const {
        return {b_.lamp.x * b_.focal_length + b_.lamp.z * b_.centre.x,
                b_.lamp.y * b_.focal_length + b_.lamp.z * b_.centre.y, b_.lamp.z};
    }
    Ray ray(const Vec2d& film) const {
        return {Vec3(0.0f), glm::normalize(Vec3(float(film.x - b_.centre.x), float(film.y - b_.centre.y),
                                                float(b_.focal_length)))};
    }
    RayEnd end_of(const Vec2d& film) const {
        const int x = std::clamp(int(film.x), 0, b_.width - 1), y = std::clamp(int(film.y), 0, b_.height - 1);
        const Ray r = ray(film);
        RayEnd end;
        end.surface = is_surface(x, y);
        end.distance = end.surface ? depth(x, y) / r.direction.z : float(b_.far_distance);
        const PassingRay passing(r, lamp_);
        end.weight = float((passing.angle(double(end.distance)) - passing.angle(0.0)) / passing.distance);
        end.position = r.at(end.distance);
        end.normal = end.surface ? normal(x, y) : -r.direction;
        return end;
    }

  private:
    float depth(int x, int y) const {
        return b_.depth[std::size_t(y) * std::size_t(b_.width) + std::size_t(x)];
    }
    bool is_surface(int x, int y) const { return depth(x, y) > 0.0f && std::isfinite(depth(x, y)); }
    Vec3 place(int x, int y) const {
        const Vec3 direction = ray({x + 0.5, y + 0.5}).direction;
        return (depth(x, y) / direction.z) * direction;
    }
    /// To the neighbour along one axis whose depth is nearer: across an edge of the surface the other one
    /// holds.
    Vec3 step(int x, int y, int dx, int dy) const {
        Vec3 best(0.0f);
        float smallest = core::infinity;
        for (const int sign : {1, -1}) {
            const int a = x + sign * dx, b = y + sign * dy;
            if (a < 0 || b < 0 || a >= b_.width || b >= b_.height || !is_surface(a, b)) continue;
            const float off = std::fabs(depth(a, b) - depth(x, y));
            if (off < smallest) smallest = off, best = float(sign) * (place(a, b) - place(x, y));
        }
        return best;
    }
    Vec3 normal(int x, int y) const {
        const Vec3 n = glm::cross(step(x, y, 0, 1), step(x, y, 1, 0));
        const float length = glm::length(n);
        return length > 0.0f ? n / length : Vec3(0.0f, 0.0f, -1.0f);
    }

    const DepthBuffer& b_;
    Vec3 lamp_;
};

struct Task final : InScatteringTask {
    const DepthView& view;
    const MarchFunction& host;
    std::uint64_t& marched;
    Task(const DepthView& v, const MarchFunction& h, std::uint64_t& m) : view(v), host(h), marched(m) {}
    Ray ray(const Vec2d& film) override { return view.ray(film); }
    RayEnd end_of(const Vec2d& film) override { return view.end_of(film); }
    MarchedRay march(const Vec2d& film, const RayEnd& end) override {
        ++marched;
        const Rgb radiance = host(film, double(end.distance));
        if (!core::is_finite(radiance))
            throw std::invalid_argument("the marching function gave radiance that is not finite");
        return {radiance, Rgb(1.0f)};
    }
};
struct Source final : InScatteringSource {
    const DepthView& view;
    const MarchFunction& host;
    std::uint64_t& marched;
    Source(const DepthView& v, const MarchFunction& h, std::uint64_t& m) : view(v), host(h), marched(m) {}
    std::unique_ptr<InScatteringTask> start() const override {
        return std::make_unique<Task>(view, host, marched);
    }
};

}  // namespace

DepthBufferLight light_over(const DepthBuffer& buffer, int lines, const LineSampling& sampling,
                            const MarchFunction& march) {
    if (lines < 1 || sampling.initial < 2 || !(sampling.tolerance >= 0.0f))
        throw std::invalid_argument(
            "a line, two samples of it and a tolerance that is not negative are needed");
    const DepthView view(buffer);
    DepthBufferLight result;
    const Source source(view, march, result.marched);
    const auto in_order = [](int n, const std::function<void(int)>& body) {
        for (int i = 0; i < n; ++i) body(i);
    };
    const FilmRectangle frame{{0.0, 0.0}, {double(buffer.width), double(buffer.height)}};
    const EpipolarPicture picture(EpipolarLines(view.lamp_on_film(), frame, lines, 0.5), sampling, source,
                                  in_order);
    Task task(view, march, result.marched);
    result.light.reserve(buffer.depth.size());
    for (int y = 0; y < buffer.height; ++y)
        for (int x = 0; x < buffer.width; ++x) {
            const Vec2d film{x + 0.5, y + 0.5};
            const RayEnd end = view.end_of(film);
            const auto found = picture.light_at(film, end, task);
            result.light.push_back(found ? *found : task.march(film, end).radiance);
        }
    return result;
}

}  // namespace mote::screenspace
