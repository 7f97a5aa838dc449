#include "core/scene/callback_scene.h"

#include <algorithm>

namespace mote::core {

SurfaceHit ForeignSurface::hit(const Ray& ray, float t, const Vec3& geometric_normal, float error) const {
    SurfaceHit hit;
    hit.t = t, hit.position = ray.at(t), hit.geometric_normal = geometric_normal;
    hit.shading = Frame(geometric_normal), hit.error = error, hit.shape = this;
    return hit;
}

CallbackScene::CallbackScene(SceneCallbacks callbacks) : calls_(std::move(callbacks)) {
    if (calls_.bounds.empty()) throw InputError("a scene of callbacks needs its bounds");
    if (!calls_.first_hit && !calls_.medium && !calls_.transmittance)
        throw InputError("a scene of callbacks needs first_hit, a medium, or both");
    std::vector<float> power;
    for (const auto& emitter : calls_.emitters) {
        if (emitter->traits().kind == EmitterKind::environment) environment_ = emitter.get();
        const float radius = calls_.bounds.radius();
        emitter->set_scene_bounds(calls_.bounds.center(), radius > 0.0f ? radius : 1.0f);
        power.push_back(average(emitter->power()));
        if (!(power.back() >= 0.0f) || !std::isfinite(power.back()))
            throw InputError("a light has a power that is negative or not finite");
    }
    by_power_ = Distribution1D(power);
    if (by_power_.empty() && !power.empty())  // all black: any choice is right
        by_power_ = Distribution1D(std::vector<float>(power.size(), 1.0f));
    for (std::size_t i = 0; i < power.size(); ++i)
        calls_.emitters[i]->set_direct_probability(by_power_.probability(i));
}

std::optional<SurfaceHit> CallbackScene::first_hit(const Ray& ray) const {
    if (!calls_.first_hit) return std::nullopt;
    std::optional<SurfaceHit> hit = calls_.first_hit(ray);
    if (!hit) return hit;
    if (!hit->shape) throw InputError("first_hit gave a hit without a surface");
    const float sum = hit->t + glm::dot(hit->geometric_normal, Vec3(1.0f)) + hit->error;
    if (!is_finite(hit->position) || !std::isfinite(sum))
        throw InputError("first_hit gave a hit whose distance, position or normal is not finite");
    return hit;
}

bool CallbackScene::visible(const Ray& segment) const {
    return calls_.visible ? calls_.visible(segment) : !first_hit(segment);
}

void CallbackScene::find_occluded(std::span<ShadowPacket> packets) const {
    if (calls_.find_occluded) return calls_.find_occluded(packets);
    for (ShadowPacket& p : packets)
        for (int i = 0; i < ShadowPacket::width; ++i) {
            if (p.t_max[i] < p.t_min[i]) continue;
            const Vec3 origin = p.origin(i), way = p.direction(i);
            const float length = glm::length(way);  // of packets it need not be 1
            if (!visible({origin, way / length, p.t_min[i] * length, p.t_max[i] * length}))
                p.t_max[i] = -infinity;
        }
}

Rgb CallbackScene::transmittance(const Vec3& from, const Vec3& to, const MediumState&, Rng& rng,
                                 TrackingCounters& counters) const {
    if (calls_.transmittance) return calls_.transmittance(from, to);
    const Vec3 way = to - from;
    const float distance = glm::length(way);
    if (!calls_.medium || !(distance > 0.0f)) return Rgb(1.0f);
    return calls_.medium->transmittance({from, way / distance, 0.0f, distance}, rng, counters);
}

const Medium* CallbackScene::connect(const Ray& ray, const MediumState&, PathWeights& weights, Rng& rng,
                                     TrackingCounters& counters) const {
    if (calls_.transmittance)
        weights.throughput *= calls_.transmittance(ray.at(ray.t_min), ray.at(ray.t_max));
    else if (calls_.medium)
        calls_.medium->connect(ray, weights, rng, counters);
    return is_black(weights.throughput) ? nullptr : calls_.medium.get();
}

Bounds3 CallbackScene::medium_extent(const Medium& medium) const {
    Bounds3 box = calls_.bounds;
    const Bounds3 own = medium.bounds();
    box.lower = glm::max(box.lower, own.lower), box.upper = glm::min(box.upper, own.upper);
    return box;
}

LightChoice CallbackScene::choose_light(const LightReceiver&, float u) const {
    return choose_emitter_by_power(u);
}

float CallbackScene::light_probability(const LightReceiver&, const Emitter* emitter) const {
    return probability_by_power(emitter);
}

LightChoice CallbackScene::choose_emitter_by_power(float u, float* remapped) const {
    if (by_power_.empty()) return {nullptr, 0.0f};
    const auto sampled = by_power_.sample_discrete(u);
    if (remapped) *remapped = sampled.remapped;
    return {calls_.emitters[sampled.index].get(), sampled.probability};
}

float CallbackScene::probability_by_power(const Emitter* emitter) const {
    const auto found = std::find_if(calls_.emitters.begin(), calls_.emitters.end(),
                                    [&](const auto& e) { return e.get() == emitter; });
    if (found == calls_.emitters.end()) return 0.0f;
    return by_power_.probability(std::size_t(found - calls_.emitters.begin()));
}

MediumState CallbackScene::emitter_medium_state(const Emitter&, const EmissionSample&) const {
    return medium_state();
}

MediumState CallbackScene::medium_state() const {
    MediumState state;
    state.set_outside(calls_.medium.get());
    return state;
}

}  // namespace mote::core
