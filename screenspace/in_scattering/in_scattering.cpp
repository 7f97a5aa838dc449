#include "screenspace/in_scattering/in_scattering.h"

#include <algorithm>
#include <stdexcept>

#include "core/scene/media_along.h"
#include "core/scene/scene.h"
#include "screenspace/in_scattering/eye_view.h"

namespace mote::screenspace {

using namespace core;

void find_segments(const RayQueries& scene, const Ray& ray, const MediumState& state,
                   std::vector<MediumSegment>& segments, WalkContext& walk) {
    segments.clear();
    Rgb panes(1.0f);
    bool pane_between = false;
    const auto add = [&](float t0, float t1, const MediumState& s) {
        if (!(t0 < t1)) return true;
        const bool continues = !segments.empty() && segments.back().medium == s.current() &&
                               segments.back().t1 == t0 && !pane_between;
        if (continues)
            segments.back().t1 = t1, segments.back().state = s;
        else
            segments.push_back({s.current(), t0, t1, s, panes});
        panes = Rgb(1.0f), pane_between = false;
        return true;
    };
    const auto pane = [&](const SurfaceHit& hit) {
        panes *= passage_through(hit, ray.direction).transmittance(), pane_between = true;
        return true;
    };
    walk.rays.boundary += scene.has_boundaries();
    for_each_part(scene, ray, state, add, pane);
}

Rgb marched_transmittance(const Medium& medium, const Ray& ray, float voxels, WalkContext& walk) {
    const Vec3d depth = medium.optical_depth_along(ray, voxels, walk.tracking);
    return {float(std::exp(-depth.x)), float(std::exp(-depth.y)), float(std::exp(-depth.z))};
}

Rgb marched_transmittance(const Ray& ray, const std::vector<MediumSegment>& segments, float voxels,
                          WalkContext& walk) {
    Rgb product = transmittance_of_media(ray, segments, voxels, walk);
    for (const MediumSegment& s : segments)
        if (s.t0 <= ray.t_max) product *= s.panes;  // a part may begin at a pane
    return product;
}

Rgb transmittance_of_media(const Ray& ray, const std::vector<MediumSegment>& segments, float voxels,
                           WalkContext& walk) {
    Rgb product(1.0f);
    for (const MediumSegment& s : segments)
        if (s.medium && s.t0 < ray.t_max)
            product *= marched_transmittance(
                *s.medium, {ray.origin, ray.direction, s.t0, std::min(s.t1, ray.t_max)}, voxels, walk);
    return product;
}

InScattering::InScattering(const Scene& scene, const Emitter& light, const MarchSettings& settings,
                           const MarchAccelerations& accelerations)
    : InScattering(scene, scattering_extent(scene), light, settings, accelerations) {}

InScattering::InScattering(const RayQueries& scene, const Bounds3& scattering, const Emitter& light,
                           const MarchSettings& settings, const MarchAccelerations& accelerations)
    : scene_(scene), light_(light), settings_(settings), accelerations_(accelerations), media_(scattering) {
    const auto position = LitScene::light_position(light);
    if (!position) throw std::invalid_argument("in-scattering along rays: the light has no position");
    if (settings.steps < 1) throw std::invalid_argument("in-scattering along rays: at least one step");
    position_ = *position;
    if (const auto* spot = dynamic_cast<const lights::ConeLight*>(&light)) cone_ = spot->cone();
    if (!accelerations.space) return;
    if (const auto analytic = AnalyticLight::of(light)) analytic_light_.emplace(*analytic);
    for (const auto& medium : scene.media())
        if (const auto analytic = AnalyticMedium::of(*medium)) analytic_media_.push_back(*analytic);
}

std::optional<Interval> InScattering::lit_part(const Ray& ray) const {
    if (media_.empty()) return std::nullopt;
    const auto box = intersect(media_, ray);
    if (!box || !cone_) return box;
    const auto cone = lights::inside_cone(*cone_, ray, double(box->t0), double(box->t1));
    if (!cone || !(float(cone->first) < float(cone->second))) return std::nullopt;
    return Interval{float(cone->first), float(cone->second)};
}

double InScattering::unshadowed(const Ray& ray, double t0, double t1) const {
    const PassingRay passing(ray, position_);
    return (passing.angle(t1) - passing.angle(t0)) / passing.distance;
}

/// Transmittance of the media up to `to`; scratch.eye holds the segments.
Rgb InScattering::eye_transmittance(const Ray& ray, float to, MarchScratch& scratch) const {
    return marched_transmittance({ray.origin, ray.direction, ray.t_min, to}, scratch.eye, settings_.voxels,
                                 scratch.walk);
}

MarchedRay InScattering::march(const Ray& ray, const MediumState& state, MarchScratch& scratch) const {
    MarchedRay result;
    ++scratch.rays;
    find_segments(scene_, ray, state, scratch.eye, scratch.walk);
    const auto lit = lit_part(ray);
    double t0 = 0.0, t1 = 0.0;  // of the media within the lit part
    const MediumSegment* only = nullptr;
    int media = 0;
    if (lit)
        for (const MediumSegment& s : scratch.eye) {
            const double from = std::max(s.t0, lit->t0), to = std::min(s.t1, lit->t1);
            if (!s.medium || !(from < to)) continue;
            if (!(t0 < t1)) t0 = from;
            t1 = to, only = &s, ++media;
        }
    if (media == 1)
        if (const auto exact = integrate(ray, t0, t1, *only, scratch)) {
            result.radiance = eye_transmittance(ray, float(t0), scratch) * *exact;
            result.transmittance = eye_transmittance(ray, ray.t_max, scratch);
            return result;
        }
    march_steps(ray, t0, t1, scratch, result);
    return result;
}

}  // namespace mote::screenspace
