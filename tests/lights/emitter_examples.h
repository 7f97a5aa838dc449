// One light of every kind, with its shape where it has one, ready to use.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/analytic_shapes.h"
#include "core/geometry/triangle_mesh.h"
#include "core/materials/texture.h"
#include "lights/emitters/emitters.h"

namespace mote::tests {

using namespace mote::core;

/// A texture given by a function of uv.
class FunctionTexture final : public Texture {
  public:
    FunctionTexture(std::function<Rgb(const Vec2&)> f, const Rgb& mean, float minimum, float maximum)
        : f_(std::move(f)), mean_(mean), minimum_(minimum), maximum_(maximum) {}
    Rgb eval(const core::TextureCoordinates& uv) const override { return f_(uv); }
    Rgb mean() const override { return mean_; }
    float maximum() const override { return maximum_; }
    float minimum() const override { return minimum_; }

  private:
    std::function<Rgb(const Vec2&)> f_;
    Rgb mean_;
    float minimum_, maximum_;
};

/// Red rises with u, green with v, blue is 1 in the left half.
inline std::shared_ptr<Texture> gradient_texture() {
    return std::make_shared<FunctionTexture>(
        [](const Vec2& uv) { return Rgb(uv.x, uv.y, uv.x < 0.5f ? 1.0f : 0.0f); }, Rgb(0.5f), 0.0f, 1.0f);
}

/// A smooth sky with colours that differ, brighter towards one side, with one bright patch.
inline Bitmap sky_picture(int width = 16, int height = 9) {
    Bitmap picture{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float s = std::sin(2.0f * pi * (float(x) + 0.5f) / float(width));
            const float up = 1.0f - float(y) / float(height);
            picture.pixels.emplace_back(1.2f + s, 0.3f + up, y == 2 && x == 3 ? 20.0f : 0.5f);
        }
    return picture;
}

struct LightExample {
    std::string name;
    std::shared_ptr<Emitter> light;
    std::shared_ptr<Shape> shape;  ///< of area lights
};

inline std::shared_ptr<Shape> mesh_shape(MeshData data, const Transform& to_world) {
    transform_mesh(data, to_world);
    return std::make_shared<TriangleMesh>(std::move(data));
}

inline LightExample on_shape(std::string name, std::shared_ptr<Shape> shape,
                             std::shared_ptr<Emitter> light = lights::make_area_light(Rgb(3, 2, 1))) {
    shape->emitter = light;
    light->set_shape(shape.get());
    return {std::move(name), std::move(light), std::move(shape)};
}

/// +z turned to -z about the x axis, then moved.
inline Transform facing_down(const Vec3d& position, double tilt = 0.0) {
    glm::dmat4 m = glm::translate(glm::dmat4(1.0), position);
    return Transform(glm::rotate(m, 3.14159265358979323846 + tilt, Vec3d(1, 0, 0)));
}

/// Every light shines on the neighbourhood of the origin, from above (z > 0). The scene is a sphere of
/// radius 3 about the point (0, 0, 1).
inline std::vector<LightExample> light_examples() {
    using namespace mote::lights;
    SpotSettings spot;
    spot.to_world = facing_down({0.3, -0.2, 2.0}, 0.1);
    spot.intensity = Rgb(5, 4, 3);
    SpotSettings textured = spot;
    textured.texture = gradient_texture();
    ProjectorSettings projector;
    projector.to_world = spot.to_world, projector.scale = 2.0f, projector.tan_half_fov_x = 0.3;
    ProjectorSettings pictured = projector;
    pictured.irradiance = gradient_texture();
    const auto turned = Transform(glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(Vec3d(1, 2, 3))));
    const auto small = [](const Transform& t) {
        return t * Transform(glm::scale(glm::dmat4(1.0), Vec3d(0.5)));
    };
    std::vector<LightExample> all{
        {"point", make_point_light({0.5, 0.2, 2.0}, Rgb(3, 2, 1)), nullptr},
        {"spot", make_spot_light(spot), nullptr},
        {"textured spot", make_spot_light(textured), nullptr},
        {"projector", make_projector_light(projector), nullptr},
        {"textured projector", make_projector_light(pictured), nullptr},
        {"directional", make_directional_light({0.3, 0.2, -1.0}, Rgb(3, 2, 1)), nullptr},
        {"constant", make_constant_light(Rgb(3, 2, 1)), nullptr},
        {"envmap", make_environment_map(sky_picture(), turned, 1.5f), nullptr},
        on_shape("rectangle", mesh_shape(make_rectangle(), small(facing_down({0.1, 0.2, 1.5}, 0.3)))),
        on_shape("textured rectangle", mesh_shape(make_rectangle(), small(facing_down({0.1, 0.2, 1.5}))),
                 make_area_light(gradient_texture())),
        on_shape("cube", mesh_shape(make_cube(), small(facing_down({0.1, 0.2, 1.5}, 0.5)))),
        on_shape("sphere", make_sphere({0.2, 0.1, 1.5}, 0.4, {}, false)),
        on_shape("inverted sphere", make_sphere({0.0, 0.0, 1.0}, 2.5, {}, true)),
        on_shape("disk", make_disk(small(facing_down({0.1, 0.2, 1.5}, -0.4)), false)),
        on_shape("cylinder", make_cylinder({-0.5, 0, 1}, {0.5, 0.2, 1.2}, 0.2, {}, false)),
    };
    for (const auto& example : all) example.light->set_scene_bounds(Vec3(0, 0, 1), 3.0f);
    return all;
}

}  // namespace mote::tests
