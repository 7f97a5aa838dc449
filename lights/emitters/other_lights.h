// A scene without some of its lights, for methods that add the light of these themselves, one after the
// other: what is sampled then is one of the others.
#pragma once

#include <vector>

#include "core/scene/lit_scene.h"

namespace mote::lights {

class OtherLights final : public core::LitScene {
  public:
    /// `scene` must outlive this. Each sample evaluates the probabilities of all that are left out: a few.
    OtherLights(const core::LitScene& scene, std::vector<const core::Emitter*> left_out);

    /// True if there is any other light.
    bool any() const { return any_; }

    core::LightChoice choose_light(const core::LightReceiver& receiver, float u) const override;
    float light_probability(const core::LightReceiver& receiver, const core::Emitter* emitter) const override;

    std::optional<core::SurfaceHit> first_hit(const core::Ray& ray) const override {
        return scene_.first_hit(ray);
    }
    bool visible(const core::Ray& segment) const override { return scene_.visible(segment); }
    void find_occluded(std::span<core::ShadowPacket> packets) const override {
        scene_.find_occluded(packets);
    }
    bool attenuates() const override { return scene_.attenuates(); }
    core::Rgb transmittance(const core::Vec3& from, const core::Vec3& to, const core::MediumState& state,
                            core::Rng& rng, core::TrackingCounters& counters) const override {
        return scene_.transmittance(from, to, state, rng, counters);
    }
    const core::Medium* connect(const core::Ray& ray, const core::MediumState& state,
                                core::PathWeights& weights, core::Rng& rng,
                                core::TrackingCounters& counters) const override {
        return scene_.connect(ray, state, weights, rng, counters);
    }
    bool has_boundaries() const override { return scene_.has_boundaries(); }
    void boundaries_along(const core::Ray& ray, std::vector<core::SurfaceHit>& hits) const override {
        scene_.boundaries_along(ray, hits);
    }
    void visit_boundaries(const core::Ray& ray, BoundaryVisitor visitor, const void* visit) const override {
        scene_.visit_boundaries(ray, visitor, visit);
    }
    bool has_panes() const override { return scene_.has_panes(); }
    bool has_coloured_panes() const override { return scene_.has_coloured_panes(); }
    std::span<const std::shared_ptr<core::Medium>> media() const override { return scene_.media(); }
    core::Bounds3 medium_extent(const core::Medium& medium) const override {
        return scene_.medium_extent(medium);
    }
    core::Bounds3 bounds() const override { return scene_.bounds(); }
    std::span<const std::shared_ptr<core::Emitter>> emitters() const override { return scene_.emitters(); }
    /// Null where it is left out: then directions do not find it either.
    const core::Emitter* environment() const override {
        const core::Emitter* sky = scene_.environment();
        return is_left_out(sky) ? nullptr : sky;
    }
    core::LightChoice choose_emitter_by_power(float u, float* remapped) const override {
        return scene_.choose_emitter_by_power(u, remapped);
    }
    float probability_by_power(const core::Emitter* emitter) const override {
        return scene_.probability_by_power(emitter);
    }
    core::MediumState emitter_medium_state(const core::Emitter& emitter,
                                           const core::EmissionSample& sample) const override {
        return scene_.emitter_medium_state(emitter, sample);
    }

  private:
    bool is_left_out(const core::Emitter* emitter) const;
    /// That a sample of the scene is one of the others.
    float probability_of_others(const core::LightReceiver& receiver) const;

    const core::LitScene& scene_;
    std::vector<const core::Emitter*> left_out_;
    bool any_;
};

}  // namespace mote::lights
