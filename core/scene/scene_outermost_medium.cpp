// The medium around everything: one for the whole scene, whichever element names it.
//
// The sensor, a light, or a shape by its exterior: each may name it, and one name is enough for all that lies
// outside of all shapes. Who is inside of a shape says nothing about what is outside. Two names are an error,
// unless open walls part the outside (scene_media.cpp).
#include <algorithm>

#include "core/objects/error.h"
#include "core/scene/scene.h"

namespace mote::core {
namespace {

/// Element that names the outermost medium, and where in the scene file.
struct Naming {
    const Medium* medium;
    std::string who;
    SourceLocation where;
};

std::string text_of(const SourceLocation& where) {
    return where.line > 0 ? where.file + ":" + std::to_string(where.line) : where.file;
}

std::string name_of(const Medium& medium) {
    return medium.id.empty() ? "a medium" : "medium '" + printable(medium.id) + "'";
}

}  // namespace

/// True if some of the shape's surface lies outside of all other closed shapes, by a few points.
bool Scene::reaches_outside(const Shape& shape) const {
    constexpr int points = 16;
    for (int i = 0; i < points; ++i) {
        // Steps of the golden ratio spread over the surface, and meet no edge.
        const Vec2 u(0.37f + 0.618034f * float(i), (float(i) + 0.61f) / float(points));
        const ShapeSample s = shape.sample_area({u.x - std::floor(u.x), u.y});
        if (!medium_state_near(s.position, nullptr, &shape).inside_any()) return true;
    }
    return false;
}

/// Open walls may all agree on what lies before them.
const Medium* Scene::exterior_of_all_walls() const {
    if (!outside_is_parted_) return nullptr;
    const Medium* common = boundaries_.front().shape->exterior.get();
    for (const Boundary& b : boundaries_)
        if (b.shape->exterior.get() != common) return nullptr;
    return common;
}

/// A medium that something names where `here` holds: not when it is that of a shape around it.
bool Scene::names_outermost(const Medium* medium, const MediumState& here) const {
    if (!medium) return false;
    return std::none_of(boundaries_.begin(), boundaries_.end(), [&](const Boundary& b) {
        return b.closed && b.shape->interior.get() == medium && here.inside(*b.shape);
    });
}

void Scene::find_outermost_medium() {
    std::vector<Naming> names;
    const auto add = [&](const Medium* medium, const MediumState& here, std::string who,
                         const SourceLocation& where) {
        if (names_outermost(medium, here)) names.push_back({medium, std::move(who), where});
    };
    const Camera& camera = *parts_.camera;
    if (camera.medium)
        add(camera.medium.get(), medium_state_at(eye_start(), nullptr), "the sensor", camera.medium_where);
    for (const auto& emitter : parts_.emitters) {
        if (!emitter->medium || emitter->traits().kind == EmitterKind::area) continue;
        const auto position = light_position(*emitter);
        const MediumState here = position ? medium_state_at(*position, nullptr) : MediumState();
        add(emitter->medium, here, "a light", emitter->medium_where);
    }
    for (const auto& shape : parts_.shapes) {
        if (!shape->emitter || !shape->emitter->medium) continue;
        const ShapeSample s = shape->sample_area({0.37f, 0.61f});
        const MediumState here = area_light_state(*shape->emitter, *shape, s.position, s.normal);
        add(shape->emitter->medium, here, "a light", shape->emitter->medium_where);
    }
    for (const Boundary& b : boundaries_)
        if (b.closed && b.shape->exterior && reaches_outside(*b.shape))
            names.push_back({b.shape->exterior.get(), "the exterior of a shape", b.shape->exterior_where});
    if (names.empty()) {
        outermost_ = exterior_of_all_walls();
        return;
    }
    const Naming& first = names.front();
    const auto other =
        std::find_if(names.begin(), names.end(), [&](const Naming& n) { return n.medium != first.medium; });
    if (other == names.end()) {
        outermost_ = first.medium, outermost_where_ = first.where;
    } else if (!outside_is_parted_) {
        throw InputError("a scene has one outermost medium, and here it has two: " + name_of(*other->medium) +
                             ", named by " + other->who + ", and " + name_of(*first.medium) + ", named by " +
                             first.who + " (" + text_of(first.where) + ")",
                         other->where);
    }
}

}  // namespace mote::core
