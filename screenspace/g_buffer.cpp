#include "screenspace/g_buffer.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "core/materials/bsdf.h"
#include "core/render/integrator.h"
#include "core/scene/scene.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// Solid angle of the triangle that three unit directions span (Van Oosterom and Strackee 1983).
double triangle_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
    return 2.0 * std::atan2(volume, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

void fill_pixel(GBuffer& buffer, const Scene& scene, int x, int y) {
    const std::size_t i = buffer.index(x, y);
    const Ray ray = scene.camera().sample_ray({float(x) + 0.5f, float(y) + 0.5f}, Vec2(0.5f));
    buffer.view[i] = ray.direction;
    buffer.solid_angle[i] = pixel_solid_angle(scene.camera(), x, y);
    const auto hit = scene.rays().closest(ray);
    if (!hit) return;

    const Vec3 wo = -ray.direction;
    const auto towards_viewer = [&](const Vec3& n) {
        return glm::dot(hit->geometric_normal, wo) < 0 ? -n : n;
    };
    buffer.hit[i] = 1, buffer.emissive[i] = hit->shape->emitter != nullptr;
    buffer.distance[i] = hit->t, buffer.position[i] = hit->position;
    buffer.geometric_normal[i] = towards_viewer(hit->geometric_normal);
    buffer.shading_normal[i] = towards_viewer(hit->shading.n);
    buffer.shape[i] = hit->shape, buffer.uv[i] = hit->uv;
    if (hit->shape->bsdf)
        buffer.reflectance[i] = hit->shape->bsdf->albedo(BsdfPoint{hit->uv}, hit->shading.to_local(wo));
}

}  // namespace

GBuffer::GBuffer(int w, int h) : width(w), height(h) {
    if (w <= 0 || h <= 0) throw std::invalid_argument("a G-buffer needs at least one pixel");
    const std::size_t n = pixel_count();
    distance.assign(n, infinity);
    position.assign(n, Vec3(0.0f)), geometric_normal = shading_normal = view = position;
    reflectance.assign(n, Rgb(0.0f)), solid_angle.assign(n, 0.0f);
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

GBuffer make_g_buffer(const Scene& scene, int width, int height) {
    GBuffer buffer(width, height);
    const std::atomic<bool> never{false};
    for_each_tile(width, height, 32, never, [&](int x0, int y0, int x1, int y1) {
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) fill_pixel(buffer, scene, x, y);
    });
    return buffer;
}

}  // namespace mote::screenspace
