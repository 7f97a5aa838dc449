#include "experiments/benchmarks/half_million.h"

#include <fmt/format.h>

#include "core/formats/xml/scene_loader.h"
#include "core/geometry/triangle_mesh.h"
#include "core/materials/bsdf.h"
#include "core/objects/properties.h"
#include "session/registry.h"

namespace mote::benchmarks {

using namespace core;

namespace {

constexpr int wall_cells = 180, ball_cells = 168;  // 6 * 2 * 180^2 + 2 * 2 * 168^2 = 501,696 triangles

/// A smooth field in [0, 1] with detail at several sizes.
float bumps(const Vec3& p) {
    float sum = 0.0f, amplitude = 0.5f;
    for (float f = 3.0f; f < 100.0f; f *= 2.1f, amplitude *= 0.5f)
        sum += amplitude * std::sin(f * p.x + 1.3f) * std::sin(f * p.y + 2.1f) * std::sin(f * p.z + 0.7f);
    return std::clamp(0.5f + 0.5f * sum, 0.0f, 1.0f);
}

/// n by n cells over (s, t) in [0, 1]^2.
template <typename Surface>
MeshData grid(int n, Surface&& surface) {
    MeshData mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            mesh.positions.push_back(surface(float(i) / float(n), float(j) / float(n)));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const auto a = std::uint32_t(j * (n + 1) + i), b = a + 1, c = a + std::uint32_t(n) + 1, d = c + 1;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    return mesh;
}

/// One wall of the room [-1, 1]^3: u and v span it, the bumps rise inwards and vanish at its border.
MeshData wall(const Vec3& u, const Vec3& v) {
    const Vec3 inwards = glm::cross(u, v);
    return grid(wall_cells, [=](float s, float t) {
        const Vec3 p = (2.0f * s - 1.0f) * u + (2.0f * t - 1.0f) * v - inwards;
        const float fade = std::fmin(1.0f, 20.0f * s * (1.0f - s) * t * (1.0f - t));
        return p + 0.25f * fade * bumps(p) * inwards;
    });
}

MeshData ball(const Vec3& center, float radius) {
    return grid(ball_cells, [=](float s, float t) {
        // Away from the poles by a hair, so that no triangle collapses.
        const float phi = 2.0f * pi * s, theta = 1e-3f + (pi - 2e-3f) * (1.0f - t);
        const Vec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        return center + radius * (0.8f + 0.2f * bumps(3.0f * d)) * d;
    });
}

std::shared_ptr<Bsdf> make_bsdf(const Registry& registry, const std::string& type,
                                std::map<std::string, PropertyValue> values) {
    Properties properties;
    properties.category = Category::bsdf, properties.type = type;
    for (auto& [name, value] : values) properties.values[name] = {std::move(value), {}};
    return std::dynamic_pointer_cast<Bsdf>(registry.make(properties));
}

}  // namespace

std::unique_ptr<Scene> make_room(const std::string& integrator, int width, int height, bool glossy) {
    const Registry registry = session::make_registry();
    const std::string frame = fmt::format(R"(<scene version="3.0.0">
    <integrator type="{}"/>
    <sensor type="perspective">
        <float name="fov" value="70"/>
        <transform name="to_world"><lookat origin="0, -0.7, 0" target="0, 1, -0.2" up="0, 0, 1"/></transform>
        <film type="hdrfilm">
            <integer name="width" value="{}"/><integer name="height" value="{}"/>
            <rfilter type="box"/>
        </film>
        <sampler type="independent"/>
    </sensor>
    <shape type="rectangle">
        <transform name="to_world">
            <scale value="0.3"/><rotate x="1" angle="180"/><translate z="0.7"/>
        </transform>
        <emitter type="area"><rgb name="radiance" value="10"/></emitter>
    </shape>
</scene>)",
                                          integrator, width, height);
    Scene::Parts parts = load_scene_from_string(frame, ".", registry)->parts();

    const auto add = [&](MeshData mesh, std::shared_ptr<Bsdf> bsdf) {
        auto shape = std::make_shared<TriangleMesh>(std::move(mesh));
        shape->bsdf = std::move(bsdf);
        parts.shapes.push_back(std::move(shape));
    };
    const auto grey = make_bsdf(registry, "diffuse", {{"reflectance", Rgb(0.6f)}});
    const auto red = make_bsdf(registry, "diffuse", {{"reflectance", Rgb(0.6f, 0.2f, 0.2f)}});
    const auto metal = make_bsdf(registry, "roughconductor", {{"alpha", 0.2}});
    const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    add(wall(x, y), grey), add(wall(y, x), grey);
    add(wall(y, z), red), add(wall(z, y), red);
    add(wall(z, x), grey), add(wall(x, z), grey);
    add(ball({-0.35f, 0.35f, -0.4f}, 0.35f), grey);
    add(ball({0.35f, 0.2f, -0.4f}, 0.3f), glossy ? metal : grey);
    return std::make_unique<Scene>(std::move(parts));
}

}  // namespace mote::benchmarks
