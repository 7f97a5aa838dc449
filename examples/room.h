// A closed unit cube of grey walls with a small lamp inside, as functions: the scene of another renderer.
// What its walls receive is known: power / (area (1 - reflectance)), of which power / area is direct.
#pragma once

#include <mote/core/materials/bsdfs.h>
#include <mote/core/materials/textures.h>
#include <mote/core/scene/callback_scene.h>
#include <mote/lights/emitters/emitters.h>
#include <mote/lights/virtual_lights/vpl_gather.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace room {

using namespace mote;

inline constexpr float reflectance = 0.5f, intensity = 2.0f;  // [W/sr]
inline constexpr double power = 4.0 * 3.14159265358979 * intensity, area = 6.0;
inline constexpr double direct = power / area,
                        all_light = power / (area * (1.0 - double(reflectance)));  // [W/m^2]

/// The wall that a ray from inside meets.
inline std::optional<core::SurfaceHit> hit(const core::ForeignSurface& wall, const core::Ray& ray) {
    float nearest = core::infinity;
    core::Vec3 normal(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        const float d = ray.direction[axis], t = ((d > 0.0f ? 1.0f : 0.0f) - ray.origin[axis]) / d;
        if (d == 0.0f || t >= nearest) continue;
        nearest = t, normal = core::Vec3(0.0f), normal[axis] = d > 0.0f ? -1.0f : 1.0f;
    }
    if (!(nearest > ray.t_min && nearest < ray.t_max)) return {};
    return wall.hit(ray, nearest, normal, 1e-6f);
}

struct Room {
    std::shared_ptr<core::Medium> medium = {};  ///< fills the room; null: vacuum
    core::ForeignSurface wall{core::make_diffuse(core::make_constant_texture(core::Rgb(reflectance)))};
    core::CallbackScene scene{{.first_hit = [this](const core::Ray& ray) { return hit(wall, ray); },
                               .medium = medium,
                               .emitters = {lights::make_point_light({0.4, 0.5, 0.6}, core::Rgb(intensity))},
                               .bounds = {core::Vec3(0.0f), core::Vec3(1.0f)}}};

    /// A vertex anywhere on the walls, evenly by area, seen from inside.
    core::ScatteringVertex vertex(core::Rng& rng) const {
        core::Ray ray{{rng.next_float(), rng.next_float(), rng.next_float()}, core::Vec3(0.0f)};
        const int axis = std::min(2, int(3.0f * rng.next_float()));
        ray.origin[axis] = 0.5f, ray.direction[axis] = rng.next_float() < 0.5f ? -1.0f : 1.0f;
        core::WalkEvent arrived;
        arrived.kind = core::WalkEvent::Kind::surface, arrived.hit = *scene.first_hit(ray);
        return core::make_vertex(arrived, ray);
    }
};

/// Light at receivers all over the walls, in tiles of sixteen.
struct Receivers {
    const Room& room;
    lights::GatherScratch scratch = {};
    core::WalkContext walk = {};  // counts rays

    lights::GatherContext context() { return {room.scene, scratch, walk.rays, walk.tracking}; }
    struct Mean {
        double irradiance, standard_error;  // [W/m^2]
    };
    /// `light(vertices, tile, rng)` is what the receivers of a tile reflect.
    template <typename Light>
    Mean irradiance(const Light& light) {
        constexpr int tiles = 200, lanes = lights::ReceiverLanes::width;
        core::Rng rng(7);
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < tiles; ++i) {
            std::array<core::ScatteringVertex, lanes> vertices;
            lights::ReceiverTile tile;
            for (int lane = 0; lane < lanes; ++lane) {
                vertices[std::size_t(lane)] = room.vertex(rng);
                tile.set(lane, vertices[std::size_t(lane)], core::Rgb(1.0f), room.scene.medium_state(), rng,
                         1000);
            }
            double mean = 0.0;
            for (const core::Rgb& l : light(vertices, tile, rng))
                mean += double(l.x * core::pi / reflectance) / lanes;
            sum += mean / tiles, squares += mean * mean / tiles;
        }
        return {sum, std::sqrt((squares - sum * sum) / tiles)};
    }
};

}  // namespace room
