#include "screenspace/g_buffer/g_buffer.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <stdexcept>

#include "core/film/tiles.h"
#include "core/geometry/bsdf_point.h"
#include "core/scene/camera.h"
#include "core/scene/ray_queries.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// Solid angle of the triangle that three unit directions span (Van Oosterom and Strackee 1983).
double triangle_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
    return 2.0 * std::atan2(volume, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

void enter(GBuffer& buffer, std::size_t i, const SurfaceHit& hit, const Vec3& wo) {
    const auto towards_viewer = [&](const Vec3& n) {
        return glm::dot(hit.geometric_normal, wo) < 0 ? -n : n;
    };
    buffer.hit[i] = 1, buffer.emissive[i] = hit.shape->emitter != nullptr;
    buffer.distance[i] = hit.t, buffer.position[i] = hit.position;
    buffer.geometric_normal[i] = towards_viewer(hit.geometric_normal);
    buffer.shading_normal[i] = towards_viewer(hit.shading.n);
    buffer.shape[i] = hit.shape, buffer.uv[i] = texture_place(hit);
    if (!hit.shape->bsdf) return;
    const Vec3 local = hit.shading.to_local(wo);
    buffer.reflectance[i] = hit.shape->bsdf->albedo(bsdf_point(hit), local);
    buffer.reflectance_behind[i] = hit.shape->bsdf->albedo(bsdf_point(hit), -local);
}

void fill_pixel(std::span<GBuffer> buffers, const RayQueries& scene, const Camera& camera, int x, int y,
                std::vector<SurfaceHit>& scratch) {
    const std::size_t i = buffers[0].index(x, y);
    const Ray ray = camera.sample_ray({float(x) + 0.5f, float(y) + 0.5f}, Vec2(0.5f));
    const float solid_angle = pixel_solid_angle(camera, x, y);
    for (GBuffer& buffer : buffers) buffer.view[i] = ray.direction, buffer.solid_angle[i] = solid_angle;
    peel(scene, ray, int(buffers.size()), scratch);
    for (std::size_t k = 0; k < scratch.size(); ++k) enter(buffers[k], i, scratch[k], -ray.direction);
}

}  // namespace

GBuffer::GBuffer(int w, int h) : width(w), height(h) {
    if (w <= 0 || h <= 0) throw std::invalid_argument("a G-buffer needs at least one pixel");
    const std::size_t n = pixel_count();
    distance.assign(n, infinity);
    position.assign(n, Vec3(0.0f)), geometric_normal = shading_normal = view = position;
    reflectance.assign(n, Rgb(0.0f)), reflectance_behind = reflectance, solid_angle.assign(n, 0.0f);
    hit.assign(n, 0), emissive.assign(n, 0), shape.assign(n, nullptr), uv.assign(n, Vec2(0.0f));
}

float GBuffer::surface_area(std::size_t i) const {
    if (!hit[i]) return 0.0f;
    const float cosine = std::abs(glm::dot(geometric_normal[i], view[i]));
    return solid_angle[i] * sqr(distance[i]) / std::max(cosine, 1e-4f);
}

float pixel_solid_angle(const Camera& camera, int x, int y) {
    const auto corner = [&](int i, int j) {
        return glm::normalize(Vec3d(camera.sample_ray({float(x + i), float(y + j)}, Vec2(0.5f)).direction));
    };
    const Vec3d a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
    return float(triangle_solid_angle(a, b, c) + triangle_solid_angle(a, c, d));
}

void peel(const RayQueries& scene, const Ray& ray, int count, std::vector<SurfaceHit>& hits) {
    hits.clear();
    Ray rest = ray;
    for (int k = 0; k < count; ++k) {
        auto hit = scene.first_hit(rest);
        if (!hit) return;
        const float before = glm::dot(rest.origin - ray.origin, ray.direction);
        hit->t += before;
        hits.push_back(*hit);
        rest.origin = offset_origin(*hit, ray.direction), rest.t_min = 0.0f;
        if (ray.t_max < infinity) rest.t_max = ray.t_max - glm::dot(rest.origin - ray.origin, ray.direction);
        if (!(rest.t_max > 0.0f)) return;
    }
}

GBuffer make_g_buffer(const RayQueries& scene, const Camera& camera, int width, int height) {
    return std::move(make_g_buffers(scene, camera, width, height, 1).front());
}

std::vector<GBuffer> make_g_buffers(const RayQueries& scene, const Camera& camera, int width, int height,
                                    int layers) {
    if (layers <= 0) throw std::invalid_argument("a G-buffer needs at least one layer");
    std::vector<GBuffer> buffers(std::size_t(layers), GBuffer(width, height));
    const std::atomic<bool> never{false};
    for_each_tile(width, height, 32, never, [&](int x0, int y0, int x1, int y1) {
        std::vector<SurfaceHit> scratch;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) fill_pixel(buffers, scene, camera, x, y, scratch);
    });
    return buffers;
}

GBuffer seen_from_behind(GBuffer buffer) {
    for (auto* vectors : {&buffer.view, &buffer.geometric_normal, &buffer.shading_normal})
        for (Vec3& v : *vectors) v = -v;
    buffer.reflectance.swap(buffer.reflectance_behind);
    return buffer;
}

}  // namespace mote::screenspace
