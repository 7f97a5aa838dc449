// A complete scene: checks and bounds. Media are in scene_media.cpp, lights in scene_lights.cpp.
#include "core/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/geometry/instances.h"
#include "core/objects/error.h"
#include "core/scene/light_tree.h"

namespace mote::core {
namespace {

bool any_emissive(const std::vector<std::shared_ptr<Medium>>& media) {
    return std::any_of(media.begin(), media.end(), [](const auto& m) { return m->traits().emissive; });
}

/// Cubes of lengths, and squares of densities per area, must stay within single precision.
void check_extent(const Bounds3& bounds, const std::string& file) {
    constexpr float min_reach = 1e-10f, max_reach = 1e12f;
    const float reach = max_component(glm::max(-bounds.lower, bounds.upper));
    if (!(reach > 0.0f) || (reach >= min_reach && reach <= max_reach)) return;
    throw InputError(
        fmt::format("the scene reaches {:.3g} m from its origin, which must lie between {:g} and {:g} m: use "
                    "another unit of length",
                    reach, min_reach, max_reach),
        {file, 0});
}

}  // namespace

Scene::Scene(Parts parts) : parts_(std::move(parts)) {
    collect_media();
    check();
    for (std::size_t i = 0; i < parts_.shapes.size(); ++i) {
        Shape& shape = *parts_.shapes[i];
        shape.index = std::uint32_t(i);
        shape.has_medium_boundary = shape.has_medium_boundary || shape.interior || shape.exterior;
        shape.parts_the_outside = shape.has_medium_boundary && !shape.closed();
        if (shape.emitter) shape.emitter->set_shape(&shape);
    }
    rays_ = std::make_unique<RayTracer>(parts_.shapes);
    find_bounds();
    check_extent(bounds_, parts_.file);
    check_instances();
    find_boundaries();
    find_open_space();
    find_outermost_medium();
    add_medium_lights();
    build_light_tables();
    find_eye_states();
    find_emitter_states();
}

Scene::~Scene() = default;

void Scene::check() const {
    const SourceLocation where{parts_.file, 0};
    if (!parts_.camera) throw InputError("the scene has no sensor", where);
    for (const auto& shape : parts_.shapes)
        if (!shape->bsdf) throw InputError("a shape has no BSDF", where);
    if (parts_.emitters.empty() && !any_emissive(parts_.media))
        throw InputError("the scene has no light", where);
    const auto environments =
        std::count_if(parts_.emitters.begin(), parts_.emitters.end(),
                      [](const auto& e) { return e->traits().kind == EmitterKind::environment; });
    if (environments > 1) throw InputError("the scene has more than one environment light", where);
    if (parts_.shapes.empty() && environments == 0 && parts_.media.empty())
        throw InputError("there is nothing to see: no shapes, no media, no environment", where);
}

/// Scenes built in code need not list what their shapes and camera hold already.
void Scene::collect_media() {
    const auto add = [&](const std::shared_ptr<Medium>& medium) {
        if (medium && std::find(parts_.media.begin(), parts_.media.end(), medium) == parts_.media.end())
            parts_.media.push_back(medium);
    };
    for (const auto& shape : parts_.shapes) add(shape->interior), add(shape->exterior);
    if (parts_.camera) add(parts_.camera->medium);
}

void Scene::find_bounds() {
    for (const auto& shape : parts_.shapes) bounds_.extend(shape->bounds());
    bounds_.extend(parts_.camera->position());
    for (const auto& emitter : parts_.emitters)
        if (const auto p = light_position(*emitter)) bounds_.extend(*p);
    const float radius = bounds_.radius();
    for (const auto& emitter : parts_.emitters)
        emitter->set_scene_bounds(bounds_.center(), radius > 0.0f ? radius : 1.0f);
}

/// Rays start within the scene, in front of lights at infinity, or in a medium without end; at a thousand
/// times the scene's reach it covers some 1e-6 sr.
void Scene::check_instances() const {
    constexpr double margin = 1000.0;
    const Vec3d reach(glm::max(glm::abs(bounds_.lower), glm::abs(bounds_.upper)));
    for (const auto& shape : parts_.shapes) {
        const auto* placed = dynamic_cast<const InstancedShape*>(shape.get());
        // The ray tracer enlarges smaller scenes to this size.
        if (placed && !(placed->placement().max_ray_origin() > margin * std::max(glm::length(reach), 4.0)))
            throw InputError(
                "the transform of an instance is too small for this scene: single precision does not hold "
                "its "
                "extent in the shapegroup",
                placed->placement().where());
    }
}

std::optional<SurfaceHit> Scene::first_hit(const Ray& ray) const { return rays_->closest(ray); }

bool Scene::visible(const Ray& segment) const { return !rays_->occluded(segment); }

void Scene::find_occluded(std::span<ShadowPacket> packets) const { rays_->occluded(packets); }

bool Scene::has_boundaries() const { return rays_->has_boundaries(); }

bool Scene::has_panes() const { return rays_->has_panes(); }
bool Scene::has_coloured_panes() const {
    return std::any_of(parts_.shapes.begin(), parts_.shapes.end(),
                       [](const auto& shape) { return shape->bsdf->traits().tints; });
}

Bounds3 Scene::medium_extent(const Medium& medium) const {
    Bounds3 box;
    const auto named_by = [&](const Medium* m) {
        if (m == &medium) box.extend(bounds_);
    };
    for (const auto& shape : parts_.shapes) {
        if (shape->interior.get() == &medium) box.extend(shape->closed() ? shape->bounds() : bounds_);
        named_by(shape->exterior.get());
    }
    named_by(outermost_);
    const Bounds3 own = medium.bounds();
    box.lower = glm::max(box.lower, own.lower), box.upper = glm::min(box.upper, own.upper);
    return box;
}

/// The emission of media joins the lights.
void Scene::add_medium_lights() {
    for (const auto& medium : parts_.media) {
        if (!medium->traits().emissive) continue;
        if (auto light = medium->make_emitter(medium_extent(*medium)))
            parts_.emitters.push_back(std::move(light));
    }
}

}  // namespace mote::core
