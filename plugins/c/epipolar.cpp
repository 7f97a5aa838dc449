// Epipolar sampling of a host's depth buffer: a pinhole camera, a lamp, and the host's own marching.
#include <cmath>
#include <span>

#include "plugins/c/handles.h"
#include "screenspace/epipolar/epipolar_picture.h"
#include "screenspace/in_scattering/airlight.h"

using namespace mote;
using c::required;
using core::Ray, core::Rgb, core::Vec3;
using namespace mote::screenspace;

namespace {

/// The camera, its depth buffer, and the ways of the rays to the lamp.
class DepthBuffer {
  public:
    explicit DepthBuffer(const mote_epipolar_options& o) : o_(o) {
        const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
        if (o.width < 1 || o.height < 1 || !positive(o.focal_length) || !positive(o.far_distance) ||
            o.lines < 0 || o.samples < 0 || o.samples == 1 || !(o.tolerance >= 0.0) || !o.depth || !o.march)
            throw c::InvalidArgument(
                "a size, a focal length, a far distance, a depth buffer and march() are needed");
        if (o.centre_x == 0.0 && o.centre_y == 0.0) o_.centre_x = 0.5 * o.width, o_.centre_y = 0.5 * o.height;
        lamp_ = {float(o.lamp[0]), float(o.lamp[1]), float(o.lamp[2])};
        if (!std::isfinite(glm::dot(lamp_, lamp_)) || glm::dot(lamp_, lamp_) == 0.0f)
            throw c::InvalidArgument("the lamp is not at the camera, and not at infinity");
    }

    FilmPoint lamp_on_film() const {
        return {o_.lamp[0] * o_.focal_length + o_.lamp[2] * o_.centre_x,
                o_.lamp[1] * o_.focal_length + o_.lamp[2] * o_.centre_y, o_.lamp[2]};
    }
    Ray ray(const Vec2d& film) const {
        return {Vec3(0.0f), glm::normalize(Vec3(float(film.x - o_.centre_x), float(film.y - o_.centre_y),
                                                float(o_.focal_length)))};
    }
    RayEnd end_of(const Vec2d& film) const {
        const int x = std::clamp(int(film.x), 0, o_.width - 1), y = std::clamp(int(film.y), 0, o_.height - 1);
        const Ray r = ray(film);
        RayEnd end;
        end.surface = is_surface(x, y);
        end.distance = end.surface ? depth(x, y) / r.direction.z : float(o_.far_distance);
        const PassingRay passing(r, lamp_);
        end.weight = float((passing.angle(double(end.distance)) - passing.angle(0.0)) / passing.distance);
        end.position = r.at(end.distance);
        end.normal = end.surface ? normal(x, y) : -r.direction;
        return end;
    }
    Rgb march(const Vec2d& film, float distance) const {
        float radiance[3] = {0.0f, 0.0f, 0.0f};
        o_.march(o_.user, film.x, film.y, double(distance), radiance);
        return {radiance[0], radiance[1], radiance[2]};
    }

  private:
    float depth(int x, int y) const {
        return o_.depth[std::size_t(y) * std::size_t(o_.width) + std::size_t(x)];
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
        float least = core::infinity;
        for (const int sign : {1, -1}) {
            const int a = x + sign * dx, b = y + sign * dy;
            if (a < 0 || b < 0 || a >= o_.width || b >= o_.height || !is_surface(a, b)) continue;
            const float off = std::fabs(depth(a, b) - depth(x, y));
            if (off < least) least = off, best = float(sign) * (place(a, b) - place(x, y));
        }
        return best;
    }
    Vec3 normal(int x, int y) const {
        const Vec3 n = glm::cross(step(x, y, 0, 1), step(x, y, 1, 0));
        const float length = glm::length(n);
        return length > 0.0f ? n / length : Vec3(0.0f, 0.0f, -1.0f);
    }

    mote_epipolar_options o_;
    Vec3 lamp_{0.0f};
};

struct Task final : InScatteringTask {
    const DepthBuffer& buffer;
    std::uint64_t& marched;
    Task(const DepthBuffer& b, std::uint64_t& m) : buffer(b), marched(m) {}
    Ray ray(const Vec2d& film) override { return buffer.ray(film); }
    RayEnd end_of(const Vec2d& film) override { return buffer.end_of(film); }
    MarchedRay march(const Vec2d& film, const RayEnd& end) override {
        ++marched;
        return {buffer.march(film, end.distance), Rgb(1.0f)};
    }
};
struct Source final : InScatteringSource {
    const DepthBuffer& buffer;
    std::uint64_t& marched;
    Source(const DepthBuffer& b, std::uint64_t& m) : buffer(b), marched(m) {}
    std::unique_ptr<InScatteringTask> start() const override {
        return std::make_unique<Task>(buffer, marched);
    }
};

}  // namespace

mote_status mote_epipolar(const mote_epipolar_options* given, float* light, size_t count, uint64_t* marched) {
    bool too_small = false;
    c::LastError unheard;
    const mote_status status = c::guarded(unheard, [&] {
        const mote_epipolar_options o = c::known_options(&required(given, "the options"));
        const DepthBuffer buffer(o);
        const std::size_t pixels = std::size_t(o.width) * std::size_t(o.height);
        too_small = count < 3 * pixels;
        if (too_small) throw c::InvalidArgument("the buffer is too small");
        float* to = &required(light, "the buffer");

        std::uint64_t rays = 0;
        const Source source(buffer, rays);
        const auto in_order = [](int n, const std::function<void(int)>& body) {
            for (int i = 0; i < n; ++i) body(i);
        };
        LineSampling sampling;
        if (o.samples > 0) sampling.initial = o.samples;
        if (o.tolerance > 0.0) sampling.tolerance = float(o.tolerance);
        const FilmRectangle frame{{0.0, 0.0}, {double(o.width), double(o.height)}};
        EpipolarPicture picture(EpipolarLines(buffer.lamp_on_film(), frame, o.lines > 0 ? o.lines : 512, 0.5),
                                sampling, source, in_order);
        Task task(buffer, rays);
        for (std::size_t i = 0; i < pixels; ++i) {
            const Vec2d film{double(i % std::size_t(o.width)) + 0.5, double(i / std::size_t(o.width)) + 0.5};
            const RayEnd end = buffer.end_of(film);
            const auto found = picture.light_at(film, end, task);
            const Rgb radiance = found ? *found : task.march(film, end).radiance;
            for (int c = 0; c < 3; ++c) to[3 * i + std::size_t(c)] = radiance[c];
        }
        if (marched) *marched = rays;
    });
    return too_small ? MOTE_BUFFER_TOO_SMALL : status;
}
