#include "core/render/motion_features.h"

#include <algorithm>
#include <map>

#include "core/geometry/moved_point.h"
#include "core/materials/bsdf.h"
#include "core/scene/emitter.h"
#include "core/scene/medium.h"

namespace mote::core {

namespace {

constexpr float anywhere = 0.5f * not_seen_before;  ///< [pixels] beyond the film's border

class Motion {
  public:
    Motion(const Scene& scene, const PreviousFrame& before)
        : now_(scene.camera()), then_(before.camera()), shapes_(before.counterparts(scene)) {}

    std::optional<Vec3> previous_position(const SurfaceHit& hit) const {
        const Shape* then = shapes_[hit.shape->index];
        return then ? moved_point(*hit.shape, hit.primitive, Vec3d(hit.position), *then) : std::nullopt;
    }
    Rgb vector(const SurfaceHit& hit) const {
        const auto position = previous_position(hit);
        const auto now = now_.project(hit.position, anywhere);
        const auto then = position ? then_.project(*position, anywhere) : std::nullopt;
        return now && then ? Rgb(*then - *now, 0.0f) : Rgb(not_seen_before, not_seen_before, 0.0f);
    }

  private:
    const Camera &now_, &then_;
    std::vector<const Shape*> shapes_;  ///< of the frame before, by their number in this one
};

}  // namespace

PreviousFrame::PreviousFrame(std::shared_ptr<Scene> scene)
    : shapes_(scene->shapes().begin(), scene->shapes().end()) {
    const std::shared_ptr<Camera> camera = scene->parts().camera;
    scene.reset();
    camera->medium = nullptr, camera_ = camera;
    for (const auto& shape : shapes_)
        shape->bsdf = nullptr, shape->emitter = nullptr, shape->interior = shape->exterior = nullptr;
}

std::vector<const Shape*> PreviousFrame::counterparts(const Scene& scene) const {
    const auto now = scene.shapes();
    std::vector<const Shape*> result(now.size(), nullptr);
    const bool same = std::equal(now.begin(), now.end(), shapes_.begin(), shapes_.end(),
                                 [](const auto& a, const auto& b) { return a->id == b->id; });
    std::map<std::string, const Shape*> by_id;
    if (!same)
        for (const auto& shape : shapes_)
            if (!shape->id.empty()) by_id[shape->id] = shape.get();
    for (std::size_t i = 0; i < now.size(); ++i) {
        const auto named = by_id.find(now[i]->id);
        result[i] = same ? shapes_[i].get() : named != by_id.end() ? named->second : nullptr;
    }
    return result;
}

std::vector<HitFeature> motion_features(const Scene& scene, const PreviousFrame& before) {
    const auto motion = std::make_shared<const Motion>(scene, before);
    return {{{"MotionVector", "to where the point was seen in the frame before [pixels]", true, false,
              coverage_layer},
             [motion](const FirstHit& first) { return motion->vector(first.hit); }},
            {{"PreviousP", "where the point was in the frame before", true, false, coverage_layer},
             [motion](const FirstHit& first) {
                 return motion->previous_position(first.hit).value_or(first.hit.position);
             }}};
}

}  // namespace mote::core
