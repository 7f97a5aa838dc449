// Another renderer's scene: RayQueries answered by formulas. A floor at z = 0, a ball in the way, and a slab
// of homogeneous fog between two heights. No ray tracer, no file, no registry.
#pragma once

#include <array>
#include <cmath>

#include "core/materials/bsdfs.h"
#include "core/materials/textures.h"
#include "core/scene/media_along.h"
#include "core/scene/ray_queries.h"
#include "core/scene/scattering_vertex.h"
#include "lights/shadow_maps/shadow_map_gather.h"
#include "media/homogeneous_medium.h"
#include "media/phase_functions.h"

namespace mote::tests {

/// A shape without BSDF or emitter: the floor, the ball, or the slab with fog inside.
class NamedShape final : public core::Shape {
  public:
    explicit NamedShape(const core::Bounds3& box) : box_(box) {}
    core::Bounds3 bounds() const override { return box_; }
    float area() const override { return 1.0f; }
    core::ShapeSample sample_area(const core::Vec2&) const override { return {}; }
    bool closed() const override { return true; }
    std::size_t primitive_count() const override { return 1; }

  private:
    core::Bounds3 box_;
};

class AnalyticScene final : public core::RayQueries {
  public:
    static constexpr float extent = 4.0f, fog_low = 1.0f, fog_high = 2.0f, radius = 0.4f;
    static constexpr core::Vec3 centre{0.5f, 0.0f, 3.0f};
    mutable int transmittances = 0;  ///< number of queries

    /// Extinction [1/m]; black: no fog.
    explicit AnalyticScene(const core::Rgb& sigma_t) : sigma_t_(sigma_t) {
        floor_.bsdf = core::make_diffuse(core::make_constant_texture(core::Rgb(0.8f, 0.5f, 0.2f)));
        if (core::is_black(sigma_t)) return;
        media_.push_back(std::make_shared<media::HomogeneousMedium>(
            sigma_t, core::Rgb(0.0f), core::Rgb(0.0f), std::make_shared<media::IsotropicPhase>()));
        slab_.interior = media_.front(), slab_.has_medium_boundary = true;
    }

    std::optional<core::SurfaceHit> first_hit(const core::Ray& ray) const override {
        const auto ball = hit_ball(ray);
        const float t = -ray.origin.z / ray.direction.z;
        if (t > ray.t_min && t < ray.t_max && !(ball && ball->t < t))
            return hit_at(ray, t, {0, 0, 1}, floor_);
        return ball;
    }
    bool visible(const core::Ray& segment) const override { return !first_hit(segment); }
    void find_occluded(std::span<core::ShadowPacket> packets) const override {
        for (core::ShadowPacket& p : packets)
            for (int i = 0; i < core::ShadowPacket::width; ++i)
                if (p.t_max[i] >= p.t_min[i] &&
                    !visible({{p.origin_x[i], p.origin_y[i], p.origin_z[i]},
                              {p.direction_x[i], p.direction_y[i], p.direction_z[i]},
                              p.t_min[i],
                              p.t_max[i]}))
                    p.t_max[i] = -core::infinity;
    }
    bool attenuates() const override { return has_media(); }
    core::Rgb transmittance(const core::Vec3& from, const core::Vec3& to, const core::MediumState&,
                            core::Rng&, core::TrackingCounters&) const override {
        ++transmittances;
        return through_fog(from, to);
    }
    const core::Medium* connect(const core::Ray& ray, const core::MediumState&, core::PathWeights& weights,
                                core::Rng&, core::TrackingCounters&) const override {
        weights.throughput *= through_fog(ray.at(ray.t_min), ray.at(ray.t_max));
        return nullptr;
    }
    bool has_boundaries() const override { return has_media(); }
    void boundaries_along(const core::Ray& ray, std::vector<core::SurfaceHit>& hits) const override {
        hits.clear();
        const bool down = ray.direction.z < 0.0f;
        for (const float z : {down ? fog_high : fog_low, down ? fog_low : fog_high}) {
            const float t = (z - ray.origin.z) / ray.direction.z;
            if (t > ray.t_min && t < ray.t_max)
                hits.push_back(hit_at(ray, t, {0, 0, z == fog_high ? 1.0f : -1.0f}, slab_));
        }
    }
    std::span<const std::shared_ptr<core::Medium>> media() const override { return media_; }
    core::Bounds3 medium_extent(const core::Medium&) const override { return slab_.bounds(); }
    core::Bounds3 bounds() const override { return {{-extent, -extent, 0.0f}, {extent, extent, extent}}; }

    /// exp(-sigma_t l), where l is the length within the slab.
    core::Rgb through_fog(const core::Vec3& from, const core::Vec3& to) const {
        const float low = std::min(from.z, to.z), high = std::max(from.z, to.z);
        const float in_fog = std::max(0.0f, std::min(high, fog_high) - std::max(low, fog_low)) / (high - low);
        return glm::exp(-sigma_t_ * (in_fog * glm::distance(from, to)));
    }
    /// Does the segment pass the ball?
    bool free_of_ball(const core::Vec3& from, const core::Vec3& to) const {
        const core::Vec3 d = to - from;
        const float t = std::clamp(glm::dot(centre - from, d) / glm::dot(d, d), 0.0f, 1.0f);
        return glm::distance(from + t * d, centre) > radius;
    }
    const core::Shape& floor() const { return floor_; }

  private:
    static core::SurfaceHit hit_at(const core::Ray& ray, float t, const core::Vec3& normal,
                                   const core::Shape& shape) {
        core::SurfaceHit hit;
        hit.t = t, hit.position = ray.at(t), hit.geometric_normal = normal, hit.shape = &shape;
        hit.shading = core::Frame(normal), hit.error = 1e-5f;
        return hit;
    }
    std::optional<core::SurfaceHit> hit_ball(const core::Ray& ray) const {
        const core::Vec3 o = ray.origin - centre;
        const float a = glm::dot(ray.direction, ray.direction), half = glm::dot(o, ray.direction);
        const float discriminant = half * half - a * (glm::dot(o, o) - radius * radius);
        const float t = (-half - std::sqrt(std::max(0.0f, discriminant))) / a;
        if (discriminant <= 0.0f || t <= ray.t_min || t >= ray.t_max) return std::nullopt;
        return hit_at(ray, t, glm::normalize(ray.at(t) - centre), ball_);
    }

    core::Rgb sigma_t_;
    NamedShape floor_{{{-extent, -extent, 0.0f}, {extent, extent, 0.0f}}};
    NamedShape ball_{{centre - radius, centre + radius}};
    NamedShape slab_{{{-extent, -extent, fog_low}, {extent, extent, fog_high}}};
    std::vector<std::shared_ptr<core::Medium>> media_;
};

/// Sixteen receivers on the floor, four by four, under a light in the air above: what gathering finds there.
struct FloorUnderLight {
    static constexpr core::Vec3 light{0.1f, 0.2f, 3.9f};
    static constexpr core::Rgb intensity{3.0f, 2.0f, 1.0f};
    lights::VplSet vpls;
    lights::ReceiverTile tile;
    std::array<core::ScatteringVertex, lights::ReceiverLanes::width> vertices;

    explicit FloorUnderLight(const AnalyticScene& scene) {
        lights::VirtualPointLight vpl;  // no normal: it shines in all directions
        vpl.position = light, vpl.intensity = intensity;
        vpls.lights = {vpl};
        for (int i = 0; i < lights::ReceiverLanes::width; ++i) {
            core::WalkEvent event;
            const core::Vec3 x = receiver(i), eye{0.0f, -1.0f, 2.5f};
            const core::Ray ray{eye, glm::normalize(x - eye)};
            event.kind = core::WalkEvent::Kind::surface, event.distance = glm::distance(x, eye);
            event.hit.t = event.distance, event.hit.position = x, event.hit.shape = &scene.floor();
            core::ScatteringVertex& v = vertices[std::size_t(i)] = core::make_vertex(event, ray);
            tile.set(i, v, core::Rgb(1.0f), {}, core::Rng(1), 1);
        }
    }
    static core::Vec3 receiver(int i) { return {-1.5f + float(i % 4), -1.5f + float(i / 4), 0.0f}; }
    /// rho / pi C* / d^2 I without what lies between.
    static core::Rgb unshadowed(const core::Vec3& x) {
        const core::Vec3 d = light - x;
        const float d2 = glm::dot(d, d);
        return core::Rgb(0.8f, 0.5f, 0.2f) * core::inv_pi * (d.z / (d2 * std::sqrt(d2))) * intensity;
    }
    /// The closed form at receiver i; `blocked` false plants an error: as if there were no ball.
    static core::Rgb expected(const AnalyticScene& scene, int i, bool blocked = true) {
        const core::Vec3 x = receiver(i);
        const bool free = !blocked || scene.free_of_ball(x, light);
        return free ? unshadowed(x) * scene.through_fog(x, light) : core::Rgb(0.0f);
    }
    static float largest_error(const AnalyticScene& scene, const lights::TileLight& found,
                               bool blocked = true) {
        float worst = 0.0f;
        for (int i = 0; i < lights::ReceiverLanes::width; ++i) {
            const core::Rgb off = glm::abs(found[std::size_t(i)] - expected(scene, i, blocked));
            worst = std::max(worst, core::max_component(off / unshadowed(receiver(i))));
        }
        return worst;
    }
};

/// By rays: what gather() finds at the sixteen receivers.
inline lights::TileLight traced_light(const AnalyticScene& scene, FloorUnderLight& at) {
    const auto scratch = std::make_unique<lights::GatherScratch>();
    core::RayCounters rays;
    core::TrackingCounters tracking;
    return lights::gather({scene, *scratch, rays, tracking}, at.vpls, lights::VplRange{},
                          lights::BoundedGeometry{core::infinity}, at.tile);
}

/// By a volumetric shadow map of the light.
inline lights::TileLight mapped_light(const AnalyticScene& scene, FloorUnderLight& at, int size) {
    lights::VolumetricShadowMap map;
    map.build(scene, lights::ShadowMapView::of_point(FloorUnderLight::light, size), {}, {});
    lights::ReceiverStore store;
    store.add(at.tile, 0, 0, 1, {}, 1.0f);
    const lights::MappedVpl mapped{0, &map};
    lights::TileLight found{};
    const auto gather = std::make_unique<lights::ShadowMapGather>();
    gather->run(store, at.vpls, lights::UnboundedGeometry{}, {&mapped, 1},
                [&](const auto&, int lane, const core::Rgb& light) { found[std::size_t(lane)] += light; });
    return found;
}

}  // namespace mote::tests
